//! JSON files.

use std::fs;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::{StoreError, write_whole};

/// Reads a JSON file.
///
/// # Errors
/// The file cannot be read, or contains something else.
pub fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, StoreError> {
    let bytes = fs::read(path).map_err(StoreError::file("reading", path))?;
    serde_json::from_slice(&bytes).map_err(|source| StoreError::Damaged {
        path: path.to_owned(),
        source,
    })
}

/// Writes a value as indented JSON; the file appears complete or not at all. Its folder is created
/// if it does not exist.
///
/// # Errors
/// The value cannot be written as JSON, or the file cannot be written.
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<(), StoreError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(|source| StoreError::Json {
        what: path.display().to_string(),
        source,
    })?;
    bytes.push(b'\n');
    write_file(path, &bytes)
}

/// Writes a file that appears complete or not at all. Its folder is created if it does not exist.
///
/// # Errors
/// The file cannot be written.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder {
        fs::create_dir_all(folder).map_err(StoreError::file("creating", folder))?;
    }
    write_whole(path, bytes).map_err(StoreError::file("writing", path))
}
