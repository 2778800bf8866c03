//! `twintac reproduce`: from recordings of a real sensor to an evaluated twin.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use twintac_run::{Run, RunSettings, guess_import};
use twintac_sensor::SensorFile;
use twintac_temperature::Compensation;

use super::files::expand;
use crate::Program;
use crate::arguments::{Import, Reproduce, Start};
use crate::output::print;

/// CSV files of a sensor, and their import description.
struct Recorded<'a> {
    sensor: &'a Path,
    recordings: &'a [String],
    import: Option<&'a Path>,
}

/// Runs every stage on recordings.
pub(crate) fn run(arguments: &Reproduce, program: &Program) -> Result<()> {
    let Some(sensor) = &arguments.sensor else {
        return super::paper::run(arguments, program);
    };
    let recorded = Recorded {
        sensor,
        recordings: &arguments.recordings,
        import: arguments.import.as_deref(),
    };
    let run = start(&recorded, &arguments.start, arguments.out.as_deref(), program)?;
    super::stages::finish(&run)
}

/// `twintac import`: starts a run with files of a laboratory, or guesses an import description.
pub(crate) fn import(arguments: &Import, program: &Program) -> Result<()> {
    if let Some(file) = &arguments.guess {
        return print(guess_import(file)?.trim_end());
    }
    let recorded = Recorded {
        sensor: arguments
            .sensor
            .as_deref()
            .context("give a sensor with --sensor")?,
        recordings: &arguments.recordings,
        import: arguments.import.as_deref(),
    };
    start(&recorded, &arguments.start, arguments.out.as_deref(), program).map(drop)
}

/// The settings of a run, with the temperature coefficients.
pub(super) fn settings(start: &Start) -> Result<RunSettings> {
    let mut settings = RunSettings::read(start.settings.as_deref())?;
    if let Some(file) = &start.temperature {
        settings.temperature = Some(Compensation::read(file)?);
    }
    Ok(settings)
}

fn start(recorded: &Recorded, start: &Start, out: Option<&Path>, program: &Program) -> Result<Run> {
    let sensor = SensorFile::read(recorded.sensor)?;
    let settings = settings(start)?;
    let files = expand(recorded.recordings)?;
    let import = recorded
        .import
        .map(Path::to_owned)
        .or_else(|| sensor.import())
        .with_context(|| {
            format!(
                "{} names no import description; give one with --import",
                recorded.sensor.display()
            )
        })?;
    let folder = out.map_or_else(|| PathBuf::from("runs").join(&sensor.sensor.name), Path::to_owned);
    let names = files
        .iter()
        .filter_map(|file| file.file_name())
        .map(|name| name.to_string_lossy());
    let source = names.collect::<Vec<_>>().join(", ");
    let run = Run::start(&folder, sensor, &source, start.seed, settings, program.caller()?)?;
    run.import(&import, &files)?;
    Ok(run)
}
