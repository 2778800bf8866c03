//! The rows of one file in the project's units.

use twintac_shape::Pose;

use super::description::{Column, Description, Direction, Split};
use super::table::Table;
use super::unit::Unit;
use crate::{Press, RecordingError};

/// Rows of one file, the columns converted.
pub(crate) struct Track {
    /// Line of each row in the file; `[n_rows]`.
    pub(crate) lines: Vec<u64>,
    pub(crate) time_s: Vec<f64>,
    pub(crate) x_mm: Vec<f64>,
    pub(crate) y_mm: Vec<f64>,
    /// On the z column's own scale.
    pub(crate) z_mm: Vec<f64>,
    /// Of the tip over the unloaded gel, negative inside.
    pub(crate) height_mm: Vec<f64>,
    pub(crate) force_n: Vec<f64>,
    /// As the file gives them; `[n_rows][n_taxels]`.
    pub(crate) raw: Vec<Vec<f64>>,
    /// Whether a reading lies in the usable range; `[n_rows][n_taxels]`.
    pub(crate) usable: Vec<Vec<bool>>,
    /// Number of the press, where a column gives it.
    pub(crate) press: Vec<f64>,
}

impl Track {
    /// Converts the rows after the first `dropped` ones; times must increase from there on.
    pub(crate) fn new(
        table: &Table,
        description: &Description,
        dropped: usize,
    ) -> Result<Self, RecordingError> {
        let rows = dropped..table.rows();
        let z_mm = description
            .z
            .as_ref()
            .map_or_else(|| vec![0.0; rows.len()], |z| converted(table, z, dropped));
        let contact = description.contact;
        let height_mm = match (&description.z, contact.z_points) {
            (None, _) => z_mm.clone(),
            (_, Direction::Up) => z_mm.iter().map(|z| z - contact.z_mm).collect(),
            (_, Direction::Down) => z_mm.iter().map(|z| contact.z_mm - z).collect(),
        };
        let force_n = match (&description.force, description.weight_n) {
            (Some(force), _) => converted(table, force, dropped),
            (None, weight_n) => vec![weight_n.unwrap_or(0.0); rows.len()],
        };
        let taxels: Vec<&[f64]> = description
            .taxels
            .iter()
            .map(|taxel| table.column(&taxel.column))
            .collect();
        let raw: Vec<Vec<f64>> = rows
            .clone()
            .map(|row| taxels.iter().map(|taxel| taxel[row]).collect())
            .collect();
        let [lowest, highest] = description.readings.usable;
        let usable = raw
            .iter()
            .map(|row| row.iter().map(|&raw| (lowest..=highest).contains(&raw)).collect())
            .collect();
        let press = match &description.presses {
            Split::Column { column } => table.column(column)[rows.clone()].to_vec(),
            _ => Vec::new(),
        };
        let time = description.time.clone().unwrap_or_default();
        let track = Self {
            lines: table.lines[rows].to_vec(),
            time_s: converted(table, &time, dropped),
            x_mm: converted(table, &description.x, dropped),
            y_mm: converted(table, &description.y, dropped),
            z_mm,
            height_mm,
            force_n,
            raw,
            usable,
            press,
        };
        if !matches!(description.presses, Split::Row) {
            track.check_times(table, time.column.as_deref().unwrap_or_default())?;
        }
        Ok(track)
    }

    fn check_times(&self, table: &Table, column: &str) -> Result<(), RecordingError> {
        for (row, step) in self.time_s.windows(2).enumerate() {
            if step[1] <= step[0] {
                return Err(RecordingError::Cell {
                    file: table.file.clone(),
                    line: self.lines[row + 1],
                    column: column.to_owned(),
                    problem: format!("is {} s after {} s, expected times to increase", step[1], step[0]),
                });
            }
        }
        Ok(())
    }

    /// Puts one row at the end of a press.
    pub(crate) fn push_frame(
        &self,
        row: usize,
        zero_kpa: &[Option<f64>],
        description: &Description,
        press: &mut Press,
    ) {
        let z_mm = description.gel_top_mm + self.height_mm[row];
        press.time_s.push(self.time_s[row]);
        press
            .gel_from_indenter
            .push(Pose::from_position([self.x_mm[row], self.y_mm[row], z_mm].into()));
        if let Some(force_n) = &mut press.force_n {
            force_n.push(self.force_n[row]);
        }
        let zeros = zero_kpa.iter().enumerate();
        let kpa = zeros
            .clone()
            .map(|(k, zero)| zero.map_or(f64::NAN, |zero| self.kpa(row, k, description) - zero));
        press.taxels_kpa.push(kpa.collect());
        press.taxels_raw.push(self.raw[row].clone());
        press.valid.push(
            zeros
                .map(|(k, zero)| zero.is_some() && self.usable[row][k])
                .collect(),
        );
    }

    /// The reading of one taxel before it is zeroed, kPa.
    pub(crate) fn kpa(&self, row: usize, taxel: usize, description: &Description) -> f64 {
        let line = &description.taxels[taxel];
        self.raw[row][taxel] * line.scale * description.readings.unit.factor() + line.offset_kpa
    }
}

fn converted<U: Unit>(table: &Table, column: &Column<U>, dropped: usize) -> Vec<f64> {
    match &column.column {
        Some(name) => table.column(name)[dropped..]
            .iter()
            .map(|&number| column.convert(number))
            .collect(),
        None => vec![column.offset; table.rows() - dropped],
    }
}
