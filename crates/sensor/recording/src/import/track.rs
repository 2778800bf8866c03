//! The rows of one file, converted to the project's units.

use glam::DQuat;
use twintac_shape::Pose;

use super::cell::Kind;
use super::check::UNIT_TOLERANCE;
use super::clock;
use super::description::{Column, Description, Direction, Rotation, Split, TimeColumn};
use super::median::median;
use super::table::Table;
use super::unit::Unit;
use crate::{Press, RecordingError};

/// The rows of one file with converted columns.
pub(crate) struct Track {
    /// What a row is: a line of a text, or a message of a bag.
    pub(crate) row_name: &'static str,
    /// Number of each row's line or message in the file; `[n_rows]`.
    pub(crate) lines: Vec<u64>,
    pub(crate) time_s: Vec<f64>,
    pub(crate) x_mm: Vec<f64>,
    pub(crate) y_mm: Vec<f64>,
    /// On the z column's scale.
    pub(crate) z_mm: Vec<f64>,
    /// Height of the tip above the unloaded gel; negative inside.
    pub(crate) height_mm: Vec<f64>,
    /// Rotation of the indenter; empty if it is always upright.
    pub(crate) rotation: Vec<DQuat>,
    pub(crate) force_n: Vec<f64>,
    /// Readings as in the file, NaN if missing; `[n_taxels][n_rows]`.
    pub(crate) raw: Vec<Vec<f64>>,
    /// Whether a reading exists and is in the usable range; `[n_taxels][n_rows]`.
    pub(crate) usable: Vec<Vec<bool>>,
    /// Temperatures, °C, NaN if missing; `[n_taxels][n_rows]`, empty if no column has temperatures.
    pub(crate) temperature_c: Vec<Vec<f64>>,
    /// Number of the press, if a column gives it; NaN for a row that belongs to none.
    pub(crate) press: Vec<f64>,
}

impl Track {
    /// Converts the rows after the first `dropped` ones. Their times are given and must increase
    /// from there on.
    pub(crate) fn new(
        mut table: Table,
        mut times_s: Vec<f64>,
        description: &Description,
        dropped: usize,
    ) -> Result<Self, RecordingError> {
        let n_rows = table.rows() - dropped;
        let z_mm = description
            .z
            .as_ref()
            .map_or_else(|| vec![0.0; n_rows], |z| converted(&table, z, dropped));
        let contact = description.contact;
        let height_mm = match (&description.z, contact.z_points) {
            (None, _) => z_mm.clone(),
            (_, Direction::Up) => z_mm.iter().map(|z| z - contact.z_mm).collect(),
            (_, Direction::Down) => z_mm.iter().map(|z| contact.z_mm - z).collect(),
        };
        let force_n = match (&description.force, description.weight_n) {
            (Some(force), _) => converted(&table, force, dropped),
            (None, weight_n) => vec![weight_n.unwrap_or(0.0); n_rows],
        };
        let press = match &description.presses {
            Split::Column { column } => table.column(column, Kind::Label)[dropped..].to_vec(),
            _ => Vec::new(),
        };
        let rotation = match &description.rotation {
            Some(rotation) => rotations(&table, rotation, dropped)?,
            None => Vec::new(),
        };
        times_s.drain(..dropped);
        if let Some(time) = &description.time {
            clock::spread(&mut times_s, time.repeated);
            if !matches!(description.presses, Split::Row) {
                check_times(&table, &times_s, dropped, time)?;
            }
        }
        let (x_mm, y_mm) = (
            converted(&table, &description.x, dropped),
            converted(&table, &description.y, dropped),
        );
        let temperature_c = temperatures(&table, description, dropped);
        let taxels = description.taxels.iter();
        let raw: Vec<Vec<f64>> = taxels
            .map(|taxel| {
                let mut readings = table.take_readings(&taxel.column);
                readings.drain(..dropped);
                readings
            })
            .collect();
        let [lowest, highest] = description.readings.usable;
        let is_usable = |raw: &f64| (lowest..=highest).contains(raw);
        Ok(Self {
            row_name: table.row_name,
            lines: table.lines.split_off(dropped),
            time_s: times_s,
            x_mm,
            y_mm,
            z_mm,
            height_mm,
            rotation,
            force_n,
            usable: raw
                .iter()
                .map(|raw| raw.iter().map(is_usable).collect())
                .collect(),
            raw,
            temperature_c,
            press,
        })
    }

    /// Position of a row in the file: `line 12`.
    pub(crate) fn place(&self, row: usize) -> String {
        format!("{} {}", self.row_name, self.lines[row])
    }

    /// Appends a row to a press.
    pub(crate) fn push_frame(
        &self,
        row: usize,
        zero_kpa: &[Option<f64>],
        description: &Description,
        press: &mut Press,
    ) {
        let z_mm = description.gel_top_mm + self.height_mm[row];
        press.time_s.push(self.time_s[row]);
        press.gel_from_indenter.push(Pose {
            position_mm: [self.x_mm[row], self.y_mm[row], z_mm].into(),
            rotation: self.rotation.get(row).copied().unwrap_or(DQuat::IDENTITY),
        });
        if let Some(force_n) = &mut press.force_n {
            force_n.push(self.force_n[row]);
        }
        let zeros = zero_kpa.iter().enumerate();
        let kpa = zeros
            .clone()
            .map(|(k, zero)| zero.map_or(f64::NAN, |zero| self.kpa(row, k, description) - zero));
        press.taxels_kpa.push(kpa.collect());
        press
            .taxels_raw
            .push(self.raw.iter().map(|taxel| taxel[row]).collect());
        if let Some(rows) = &mut press.temperature_c {
            rows.push(self.temperature_c.iter().map(|taxel| taxel[row]).collect());
        }
        press.valid.push(
            zeros
                .map(|(k, zero)| zero.is_some() && self.usable[k][row])
                .collect(),
        );
    }

    /// The reading of a taxel before its zero is subtracted, kPa.
    pub(crate) fn kpa(&self, row: usize, taxel: usize, description: &Description) -> f64 {
        let line = &description.taxels[taxel];
        self.raw[taxel][row] * line.scale * description.readings.kpa() + line.offset_kpa
    }

    /// The median of a taxel's usable readings before zeros are subtracted, kPa; `None` if there
    /// are none.
    pub(crate) fn median_kpa(&self, taxel: usize, description: &Description) -> Option<f64> {
        let rows = (0..self.time_s.len()).filter(|&row| self.usable[taxel][row]);
        median(rows.map(|row| self.kpa(row, taxel, description)).collect())
    }
}

fn check_times(
    table: &Table,
    times_s: &[f64],
    dropped: usize,
    time: &TimeColumn,
) -> Result<(), RecordingError> {
    for (row, step) in times_s.windows(2).enumerate() {
        if step[1] <= step[0] {
            return Err(RecordingError::Cell {
                file: table.file.clone(),
                line: table.lines[dropped + row + 1],
                column: time.column.clone().unwrap_or_default(),
                problem: format!(
                    "is {} s after {} s, expected times to increase; {}",
                    step[1],
                    step[0],
                    clock::remedy(step[0], step[1], time)
                ),
            });
        }
    }
    Ok(())
}

/// Temperatures of each taxel, °C, after the first `dropped` rows. Empty if no taxel has a
/// temperature column.
fn temperatures(table: &Table, description: &Description, dropped: usize) -> Vec<Vec<f64>> {
    let columns = (0..description.taxels.len()).map(|taxel| description.temperature_column(taxel));
    if columns.clone().all(|column| column.is_none()) {
        return Vec::new();
    }
    let settings = &description.temperatures;
    let celsius = |number: &f64| settings.unit.celsius(number * settings.scale);
    let of_taxel = |column: Option<&str>| match column {
        Some(name) => table.column(name, Kind::Reading)[dropped..]
            .iter()
            .map(celsius)
            .collect(),
        None => vec![f64::NAN; table.rows() - dropped],
    };
    columns.map(of_taxel).collect()
}

fn rotations(table: &Table, rotation: &Rotation, dropped: usize) -> Result<Vec<DQuat>, RecordingError> {
    let upright = DQuat::from_array(rotation.upright).normalize();
    let columns = rotation
        .columns
        .each_ref()
        .map(|name| &table.column(name, Kind::Number)[dropped..]);
    let rows = 0..columns[0].len();
    rows.map(|row| {
        let turn = DQuat::from_array(columns.map(|column| column[row]));
        if (turn.length() - 1.0).abs() > UNIT_TOLERANCE {
            return Err(RecordingError::Cell {
                file: table.file.clone(),
                line: table.lines[dropped + row],
                column: rotation.columns[3].clone(),
                problem: format!(
                    "ends a quaternion of length {}, expected 1; are `columns` in the order x, y, z, w?",
                    turn.length()
                ),
            });
        }
        Ok(turn.normalize() * upright.inverse())
    })
    .collect()
}

fn converted<U: Unit>(table: &Table, column: &Column<U>, dropped: usize) -> Vec<f64> {
    match &column.column {
        Some(name) => table.column(name, Kind::Number)[dropped..]
            .iter()
            .map(|&number| column.convert(number))
            .collect(),
        None => vec![column.offset; table.rows() - dropped],
    }
}
