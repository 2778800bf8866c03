//! The content of a Parquet file: presses, or frames without poses.

use std::path::Path;

use super::column::Columns;
use super::file::{damaged, decoded, holds_frames};
use super::{read, schema};
use crate::missing::known_or_nan;
use crate::{Frames, Recording, RecordingError};

/// The content of a Parquet file.
#[derive(Clone, Debug)]
pub enum Stored {
    /// Presses, from [`Recording::write_parquet`].
    Presses(Recording),
    /// Frames without poses, from [`FrameTable`](crate::FrameTable).
    Frames(Frames),
}

impl Stored {
    /// Reads a file of either kind.
    ///
    /// # Errors
    /// See [`Recording::read_parquet`].
    pub fn read_parquet(path: &Path) -> Result<Self, RecordingError> {
        let stored = decoded(path, |columns| {
            if holds_frames(columns) {
                decode_frames(columns).map(Self::Frames)
            } else {
                read::decode(columns).map(Self::Presses)
            }
        })?;
        let checked = match &stored {
            Self::Presses(recording) => return read::expect_presses(path, recording).map(|()| stored),
            Self::Frames(frames) => frames.check(),
        };
        checked.map_err(|error| damaged(path, error.to_string()))?;
        Ok(stored)
    }
}

fn decode_frames(columns: &Columns) -> Result<Frames, String> {
    let names = columns.names.iter();
    let taxels = names.filter_map(|name| name.strip_suffix(schema::ABSOLUTE_KPA));
    let taxels: Vec<String> = taxels.map(str::to_owned).collect();
    let time_s = columns.doubles(schema::TIME)?;
    let rows = |suffix: &str| -> Result<Vec<Vec<f64>>, String> {
        let mut rows = vec![vec![f64::NAN; taxels.len()]; time_s.len()];
        for (taxel, name) in taxels.iter().enumerate() {
            let name = format!("{name}{suffix}");
            let column = columns.optional_doubles(&name)?;
            if column.len() != rows.len() {
                return Err(format!(
                    "column `{name}` has {} rows, `{}` {}",
                    column.len(),
                    schema::TIME,
                    rows.len()
                ));
            }
            for (row, number) in rows.iter_mut().zip(column) {
                row[taxel] = known_or_nan(number);
            }
        }
        Ok(rows)
    };
    Ok(Frames {
        sensor: columns.metadata(schema::SENSOR_KEY)?,
        provenance: read::parse_provenance(&columns.metadata(schema::PROVENANCE_KEY)?)?,
        gap_before: columns.bools(schema::GAP_BEFORE)?,
        readings_kpa: rows(schema::ABSOLUTE_KPA)?,
        temperature_c: rows(schema::TEMPERATURE_C)?,
        taxels,
        time_s,
    })
}
