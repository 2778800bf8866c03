//! Reads a whole Parquet file.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::column::Columns;
use super::{schema, seal};
use crate::RecordingError;

/// Reads a whole file and decodes its columns.
pub(super) fn decoded<T>(
    path: &Path,
    decode: impl FnOnce(&Columns) -> Result<T, String>,
) -> Result<T, RecordingError> {
    let bytes = std::fs::read(path).map_err(|source| RecordingError::read(path, source))?;
    seal::verify(&bytes).map_err(|problem| damaged(path, problem))?;
    // A file of another program has no seal, and the Parquet decoder panics on some malformed
    // files.
    let decoded = catch_unwind(AssertUnwindSafe(|| decode(&Columns::open(bytes)?)));
    decoded
        .unwrap_or_else(|_| Err("it cannot be decoded".to_owned()))
        .map_err(|problem| damaged(path, problem))
}

pub(super) fn damaged(path: &Path, problem: String) -> RecordingError {
    RecordingError::Damaged {
        file: path.display().to_string(),
        problem,
    }
}

/// Whether the file has frames without poses.
pub(super) fn holds_frames(columns: &Columns) -> bool {
    let has = |name: &str| columns.names.iter().any(|other| other == name);
    has(schema::GAP_BEFORE) && !has(schema::PRESS)
}
