//! Files of a run, written whole or not at all.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::RunError;

/// The text of a file.
pub(crate) fn read_text(path: &Path) -> Result<String, RunError> {
    fs::read_to_string(path).map_err(RunError::file("reading", path))
}

/// Reads a JSON file that a run has written.
pub(crate) fn read_json<T: for<'de> Deserialize<'de>>(path: &Path) -> Result<T, RunError> {
    let bytes = fs::read(path).map_err(RunError::file("reading", path))?;
    serde_json::from_slice(&bytes).map_err(|source| RunError::Damaged {
        path: path.to_owned(),
        source,
    })
}

/// Writes a JSON file.
pub(crate) fn write_json(path: &Path, value: &impl Serialize) -> Result<(), RunError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(|source| RunError::Json {
        what: path.display().to_string(),
        source,
    })?;
    bytes.push(b'\n');
    write_file(path, &bytes)
}

/// Writes a file whole or not at all, in a folder that may not exist yet.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), RunError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder {
        fs::create_dir_all(folder).map_err(RunError::file("creating", folder))?;
    }
    twintac_store::write_whole(path, bytes).map_err(RunError::file("writing", path))
}

/// SHA-256 as hexadecimal digits.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    use std::fmt::Write as _;
    let mut text = String::with_capacity(64);
    for byte in Sha256::digest(bytes) {
        let _ = write!(text, "{byte:02x}");
    }
    text
}

/// SHA-256 of a file's bytes as hexadecimal digits: what tells one build of a program from another, where it is the program's own file.
///
/// # Errors
/// The file cannot be read.
pub fn sha256_of_file(path: &Path) -> Result<String, RunError> {
    Ok(sha256(&fs::read(path).map_err(RunError::file("reading", path))?))
}
