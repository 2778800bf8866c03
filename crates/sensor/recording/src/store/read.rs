//! Reads recordings.

use std::path::Path;

use glam::{DQuat, DVec3};
use twintac_shape::Pose;

use super::column::Columns;
use super::file::{damaged, decoded, holds_frames};
use super::schema;
use crate::missing::known_or_nan;
use crate::{Control, Press, Provenance, Recording, RecordingError};

impl Recording {
    /// Reads a Parquet file with the columns of [`write_parquet`](Self::write_parquet).
    /// `press_index` and temperatures may be missing, other columns are ignored, and `mounting` may
    /// have its old name `file`. Rows with the same `press` belong together and must be
    /// consecutive.
    ///
    /// # Errors
    ///
    /// The file cannot be read, is truncated or altered (files of this crate have a checksum of all
    /// bytes), lacks a column, is inconsistent ([`check`](Self::check)), or has no presses.
    pub fn read_parquet(path: &Path) -> Result<Self, RecordingError> {
        let recording = decoded(path, decode)?;
        expect_presses(path, &recording)?;
        Ok(recording)
    }
}

/// Refuses a file whose presses are inconsistent, or that has none.
pub(super) fn expect_presses(path: &Path, recording: &Recording) -> Result<(), RecordingError> {
    recording
        .check()
        .map_err(|error| damaged(path, error.to_string()))?;
    if recording.presses.is_empty() {
        return Err(RecordingError::NoPresses {
            file: path.display().to_string(),
            rows: 0,
            why: "the table is empty".to_owned(),
        });
    }
    Ok(())
}

pub(super) fn decode(columns: &Columns) -> Result<Recording, String> {
    if holds_frames(columns) {
        return Err("it holds frames without poses, and no presses".to_owned());
    }
    let version = columns.metadata(schema::VERSION_KEY)?;
    if version != schema::VERSION {
        return Err(format!(
            "its schema has version {version}, expected {}",
            schema::VERSION
        ));
    }
    let provenance = parse_provenance(&columns.metadata(schema::PROVENANCE_KEY)?)?;
    let rows = Rows::read(columns)?;
    if let Some(other) = rows
        .provenance
        .iter()
        .find(|&other| *other != provenance.to_string())
    {
        return Err(format!(
            "column `provenance` says `{other}`, the metadata `{provenance}`"
        ));
    }
    let presses = rows.press.chunk_by(|a, b| a == b).scan(0, |start, run| {
        let range = *start..*start + run.len();
        *start = range.end;
        Some(rows.press(range))
    });
    Ok(Recording {
        sensor: columns.metadata(schema::SENSOR_KEY)?,
        provenance,
        presses: presses.collect::<Result<_, _>>()?,
        taxels: rows.taxels.clone(),
    })
}

/// All rows of a file, by column.
struct Rows {
    taxels: Vec<String>,
    press: Vec<String>,
    mounting: Vec<String>,
    indenter: Vec<String>,
    control: Vec<String>,
    provenance: Vec<String>,
    time_s: Vec<f64>,
    pose: Vec<Vec<f64>>,
    force_n: Vec<Option<f64>>,
    kpa: Vec<Vec<f64>>,
    raw: Vec<Vec<f64>>,
    valid: Vec<Vec<bool>>,
    /// Empty for a file without temperatures.
    temperature_c: Vec<Vec<f64>>,
}

impl Rows {
    fn read(columns: &Columns) -> Result<Self, String> {
        let taxels: Vec<String> = columns
            .names
            .iter()
            .filter_map(|name| name.strip_suffix(schema::KPA))
            .map(str::to_owned)
            .collect();
        let of_taxels = |suffix: &str| -> Result<Vec<Vec<f64>>, String> {
            let column = |taxel: &String| {
                let readings = columns.optional_doubles(&format!("{taxel}{suffix}"))?;
                Ok(readings.into_iter().map(known_or_nan).collect())
            };
            taxels.iter().map(column).collect()
        };
        let has_temperatures = columns
            .names
            .iter()
            .any(|name| name.ends_with(schema::TEMPERATURE_C));
        let rows = Self {
            temperature_c: if has_temperatures {
                of_taxels(schema::TEMPERATURE_C)?
            } else {
                Vec::new()
            },
            press: columns.texts(schema::PRESS)?,
            mounting: columns.texts(mounting_column(columns))?,
            indenter: columns.texts(schema::INDENTER)?,
            control: columns.texts(schema::CONTROL)?,
            provenance: columns.texts(schema::PROVENANCE)?,
            time_s: columns.doubles(schema::TIME)?,
            pose: schema::POSE
                .iter()
                .map(|name| columns.doubles(name))
                .collect::<Result<_, _>>()?,
            force_n: columns.optional_doubles(schema::FORCE)?,
            kpa: of_taxels(schema::KPA)?,
            raw: of_taxels(schema::RAW)?,
            valid: taxels
                .iter()
                .map(|t| columns.bools(&format!("{t}{}", schema::VALID)))
                .collect::<Result<_, _>>()?,
            taxels,
        };
        rows.check_lengths()?;
        Ok(rows)
    }

    fn check_lengths(&self) -> Result<(), String> {
        let rows = self.press.len();
        let texts = [&self.mounting, &self.indenter, &self.control, &self.provenance].map(Vec::len);
        let of_taxels = self.kpa.iter().chain(&self.raw).chain(&self.temperature_c);
        let numbers = self.pose.iter().chain(of_taxels).map(Vec::len);
        let others = self
            .valid
            .iter()
            .map(Vec::len)
            .chain([self.time_s.len(), self.force_n.len()]);
        match texts
            .into_iter()
            .chain(numbers)
            .chain(others)
            .find(|&length| length != rows)
        {
            Some(length) => Err(format!("its columns have {rows} and {length} rows")),
            None => Ok(()),
        }
    }

    /// A press from its rows, of which there is at least one.
    fn press(&self, rows: std::ops::Range<usize>) -> Result<Press, String> {
        let first = rows.start;
        let name = &self.press[first];
        for (column, values) in [
            (schema::MOUNTING, &self.mounting),
            (schema::INDENTER, &self.indenter),
            (schema::CONTROL, &self.control),
        ] {
            if values[rows.clone()].iter().any(|value| *value != values[first]) {
                return Err(format!("column `{column}` changes during press `{name}`"));
            }
        }
        let forces = &self.force_n[rows.clone()];
        let force_n: Vec<f64> = forces.iter().flatten().copied().collect();
        if !force_n.is_empty() && force_n.len() != forces.len() {
            return Err(format!(
                "press `{name}` has a force in some frames and none in others"
            ));
        }
        let pose = |row: usize| {
            let [x, y, z, qx, qy, qz, qw] = std::array::from_fn(|axis| self.pose[axis][row]);
            Pose {
                position_mm: DVec3::new(x, y, z),
                rotation: DQuat::from_xyzw(qx, qy, qz, qw),
            }
        };
        let across = |columns: &[Vec<f64>]| -> Vec<Vec<f64>> {
            rows.clone()
                .map(|row| columns.iter().map(|column| column[row]).collect())
                .collect()
        };
        let temperature_c = across(&self.temperature_c);
        let has_temperatures = temperature_c.iter().flatten().any(|c| !c.is_nan());
        Ok(Press {
            temperature_c: has_temperatures.then_some(temperature_c),
            name: name.clone(),
            mounting: self.mounting[first].clone(),
            indenter: self.indenter[first].clone(),
            control: parse_control(&self.control[first])?,
            time_s: self.time_s[rows.clone()].to_vec(),
            gel_from_indenter: rows.clone().map(pose).collect(),
            force_n: (!force_n.is_empty()).then_some(force_n),
            taxels_kpa: across(&self.kpa),
            taxels_raw: across(&self.raw),
            valid: rows
                .clone()
                .map(|row| self.valid.iter().map(|column| column[row]).collect())
                .collect(),
        })
    }
}

/// The name of the column with the installation of gel and indenter.
fn mounting_column(columns: &Columns) -> &'static str {
    let has = |name: &str| columns.names.iter().any(|other| other == name);
    match !has(schema::MOUNTING) && has(schema::OLD_MOUNTING) {
        true => schema::OLD_MOUNTING,
        false => schema::MOUNTING,
    }
}

fn parse_control(text: &str) -> Result<Control, String> {
    let known = [Control::Pose, Control::Force]
        .into_iter()
        .find(|control| control.to_string() == text);
    known.ok_or_else(|| format!("column `control` says `{text}`, expected `pose` or `force`"))
}

pub(super) fn parse_provenance(text: &str) -> Result<Provenance, String> {
    let known = [Provenance::Real, Provenance::Emulated, Provenance::Simulated];
    let known = known
        .into_iter()
        .find(|provenance| provenance.to_string() == text);
    known.ok_or_else(|| format!("its provenance is `{text}`, expected `real`, `emulated` or `simulated`"))
}
