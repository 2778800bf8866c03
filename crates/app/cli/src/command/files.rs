//! Files that are given by name or by pattern.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use twintac_recording::Recording;
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

/// Gives recordings the name of the sensor that they are of, where `recorded_as` says that they
/// have another one for it.
pub(crate) fn rename(
    recording: &mut Recording,
    recorded_as: Option<&str>,
    sensor: &SensorFile,
) -> Result<()> {
    let Some(name) = recorded_as else {
        return Ok(());
    };
    if recording.sensor != name {
        bail!(
            "--recorded-as is `{name}`, but the recordings call their sensor `{}`",
            recording.sensor
        );
    }
    recording.sensor.clone_from(&sensor.sensor.name);
    Ok(())
}

/// Reads a sensor description, or without a file that of PhysTac.
pub(crate) fn sensor_or_phystac(file: Option<&Path>) -> Result<SensorFile> {
    Ok(file.map_or_else(SensorFile::phystac, SensorFile::read)?)
}
