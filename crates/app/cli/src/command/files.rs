//! Files that are given by name or by pattern.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use twintac_run::SensorFile;

/// The files that names and patterns stand for, sorted; each must stand for at least one.
pub(crate) fn expand(patterns: &[String]) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for pattern in patterns {
        let found = glob::glob(pattern).with_context(|| format!("`{pattern}` is no pattern of files"))?;
        let before = files.len();
        for file in found {
            files.push(file?);
        }
        if files.len() == before {
            bail!(
                "no file matches `{pattern}`; check the path, and quote patterns so that the shell leaves them alone"
            );
        }
    }
    files.sort_unstable();
    files.dedup();
    Ok(files)
}

/// Reads a sensor description, or without a file that of PhysTac.
pub(crate) fn sensor_or_phystac(file: Option<&Path>) -> Result<SensorFile> {
    Ok(file.map_or_else(SensorFile::phystac, SensorFile::read)?)
}
