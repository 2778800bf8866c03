//! `twintac fast variation`: estimates sensor variation from a trained model and recordings.

use std::path::PathBuf;

use anyhow::{Result, bail};
use twintac_model::{VariationSources, find_variation, sensor_of_model};
use twintac_recorded::Recorded;
use twintac_sensor::SensorFile;

use super::files::{expand, import_aloud, rename};
use crate::arguments::FastVariation;
use crate::output::print;
use crate::progress::Bars;

/// Estimates the widths, and prints or writes their file.
pub(crate) fn run(arguments: &FastVariation) -> Result<()> {
    let sensor = match (&arguments.sensor, &arguments.model) {
        (Some(file), _) => SensorFile::read(file)?,
        (None, Some(model)) => sensor_of_model(model)?,
        (None, None) => bail!("there is no sensor; name its description with --sensor"),
    };
    let recorded = if arguments.recordings.is_empty() {
        None
    } else {
        let mut recorded = read(arguments, &sensor)?;
        rename(&mut recorded.recording, arguments.recorded_as.as_deref(), &sensor)?;
        Some(recorded)
    };
    let command = command(arguments);
    let sources = VariationSources {
        sensor: &sensor,
        model: arguments.model.as_deref(),
        recorded: recorded.as_ref(),
        command: &command,
    };
    let found = find_variation(&sources)?;
    let Some(out) = &arguments.out else {
        return print(found.text.trim_end());
    };
    found.write(out)?;
    print(&format!("found     {}", found.found.join(", ")))?;
    print(&format!("left out  {}", found.left_out.join(", ")))?;
    print(&format!("file      {}", out.display()))
}

fn read(arguments: &FastVariation, sensor: &SensorFile) -> Result<Recorded> {
    let files = expand(&arguments.recordings)?;
    let is_csv = |file: &PathBuf| file.extension().is_some_and(|ending| ending == "csv");
    if !files.iter().any(is_csv) {
        return Ok(Recorded::read(&files, None, &Bars::default())?);
    }
    if let Some(other) = files.iter().find(|file| !is_csv(file)) {
        bail!(
            "{} is not a CSV file, but others are; give either CSV files or Parquet files and logs",
            other.display()
        );
    }
    let named = arguments.sensor.as_ref().and_then(|_| sensor.import());
    let Some(import) = arguments.import.clone().or(named) else {
        bail!(
            "there is no import description for {}; name one with --import",
            files[0].display()
        );
    };
    Ok(Recorded {
        recording: import_aloud(&import, &files)?,
        logs: Vec::new(),
    })
}

/// The command as text, for the first line of the file.
fn command(arguments: &FastVariation) -> String {
    let mut words = "twintac fast variation".to_owned();
    let mut add = |name: &str, value: &Option<PathBuf>| {
        if let Some(value) = value {
            words += &format!(" {name} {}", quoted(&value.display().to_string()));
        }
    };
    add("--model", &arguments.model);
    add("--sensor", &arguments.sensor);
    add("--import", &arguments.import);
    add("--out", &arguments.out);
    if let Some(name) = &arguments.recorded_as {
        words += &format!(" --recorded-as {}", quoted(name));
    }
    if !arguments.recordings.is_empty() {
        let patterns: Vec<String> = arguments
            .recordings
            .iter()
            .map(|pattern| quoted(pattern))
            .collect();
        words += &format!(" --recordings {}", patterns.join(" "));
    }
    words
}

/// A word, quoted for a shell if necessary.
fn quoted(word: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "/._-=+:,".contains(letter);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\n', " ").replace('\'', "'\\''"))
    }
}
