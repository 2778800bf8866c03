//! Patterns of files.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};

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
