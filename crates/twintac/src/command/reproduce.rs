//! `twintac reproduce`: recordings of a real sensor in, a judged twin out.

use std::path::PathBuf;

use anyhow::{Context, Result};

use super::files::expand;
use crate::arguments::Reproduce;
use crate::run::{Run, RunSettings};
use crate::sensor_file::read_sensor;

/// Runs every stage on recordings.
pub(crate) fn run(arguments: &Reproduce) -> Result<()> {
    let sensor = read_sensor(&arguments.sensor)?;
    let files = expand(&arguments.recordings)?;
    let import = arguments
        .import
        .clone()
        .or_else(|| sensor.import())
        .with_context(|| {
            format!(
                "{} names no import description; give one with --import",
                arguments.sensor.display()
            )
        })?;
    let folder = arguments
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from("runs").join(&sensor.sensor.name));
    let names = files
        .iter()
        .filter_map(|file| file.file_name())
        .map(|name| name.to_string_lossy());
    let source = names.collect::<Vec<_>>().join(", ");
    let run = Run::start(&folder, sensor, source, arguments.seed, RunSettings::default())?;
    run.import(&import, &files)?;
    super::stages::finish(&run)
}
