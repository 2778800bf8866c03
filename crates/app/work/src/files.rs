//! Texts of files, and their SHA-256.

use std::fs;
use std::path::Path;

use twintac_store::Digest;

use crate::WorkError;

/// The text of a file.
///
/// # Errors
/// The file cannot be read.
pub fn read_text(path: &Path) -> Result<String, WorkError> {
    fs::read_to_string(path).map_err(WorkError::file("reading", path))
}

/// SHA-256 as hexadecimal digits.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    Digest::of(bytes).to_string()
}

/// SHA-256 of a file's bytes as hexadecimal digits. For the program's own file it identifies the
/// build.
///
/// # Errors
/// The file cannot be read.
pub fn sha256_of_file(path: &Path) -> Result<String, WorkError> {
    Ok(Digest::of_file(path)?.to_string())
}
