//! Missing readings: NaN in memory, null in files.

use serde::{Deserialize, Deserializer};

/// Reads rows of readings in which some are null; null becomes NaN. JSON has no NaN, and
/// `serde_json` writes it as null.
///
/// # Errors
/// The input is not rows of numbers and nulls.
pub fn null_as_nan<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Vec<f64>>, D::Error> {
    let rows = Vec::<Vec<Option<f64>>>::deserialize(from)?;
    let row = |row: Vec<Option<f64>>| row.into_iter().map(known_or_nan).collect();
    Ok(rows.into_iter().map(row).collect())
}

/// Like [`null_as_nan`], for rows that may be absent.
pub(crate) fn some_null_as_nan<'de, D: Deserializer<'de>>(
    from: D,
) -> Result<Option<Vec<Vec<f64>>>, D::Error> {
    null_as_nan(from).map(Some)
}

/// A reading in memory.
pub(crate) fn known_or_nan(known: Option<f64>) -> f64 {
    known.unwrap_or(f64::NAN)
}

/// A reading in a file.
pub(crate) fn known(reading: f64) -> Option<f64> {
    (!reading.is_nan()).then_some(reading)
}
