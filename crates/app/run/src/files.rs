//! Files of a run, written whole or not at all.

use std::fs;
use std::path::Path;

use twintac_store::Digest;
pub(crate) use twintac_store::{read_json, write_file, write_json};

use crate::RunError;

/// The text of a file.
pub(crate) fn read_text(path: &Path) -> Result<String, RunError> {
    fs::read_to_string(path).map_err(RunError::file("reading", path))
}

/// SHA-256 as hexadecimal digits.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    Digest::of(bytes).to_string()
}

/// SHA-256 of a file's bytes as hexadecimal digits: what tells one build of a program from another, where it is the program's own file.
///
/// # Errors
/// The file cannot be read.
pub fn sha256_of_file(path: &Path) -> Result<String, RunError> {
    Ok(Digest::of_file(path)?.to_string())
}
