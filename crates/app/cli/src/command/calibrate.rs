//! `twintac calibrate`: fits the gel's material to measured presses.

use std::io::Write;
use std::sync::Arc;

use anyhow::{Context, Result};
use twintac_calibrate::{Fit, FitSettings};
use twintac_gel::calibration::{CsvPlace, Measured, calibrate, curve_of_csv, curves_of_file};
use twintac_gel::simulate_settings;
use twintac_sensor::SensorFile;
use twintac_simulate::{Gel, SimulateSettings};

use crate::arguments::Calibrate;
use crate::output::print;
use crate::progress::Bars;

/// Fits, and prints or writes the result.
pub(crate) fn run(arguments: &Calibrate) -> Result<()> {
    let sensor = SensorFile::read(&arguments.sensor)?;
    let names: Vec<String> = arguments.free.iter().map(|name| name.trim().to_owned()).collect();
    let settings = simulate_settings(SimulateSettings::fine(), arguments.settings.as_deref())?;
    let measured = measured(arguments, &sensor, &settings)?;
    let bars = Bars::default();
    let how = FitSettings {
        most_frames: arguments.frames,
        ..FitSettings::default()
    };
    let found = calibrate(&sensor, settings, measured, &names, how, &bars)?;
    if let Some(folder) = &arguments.out {
        found.write(folder, &sensor)?;
    }
    tell(&found.fit, &found.kinds())?;
    if arguments.json {
        print(&serde_json::to_string_pretty(&found)?)
    } else {
        print(found.material_toml()?.trim_end())
    }
}

fn measured(
    arguments: &Calibrate,
    sensor: &SensorFile,
    settings: &SimulateSettings,
) -> Result<Vec<Measured>> {
    let gel = Gel::new(Arc::clone(&sensor.sensor), settings.clone());
    if let Some(path) = &arguments.curves {
        return Ok(curves_of_file(path, &gel, sensor.import())?);
    }
    let indenter = arguments.indenter.clone();
    let place = CsvPlace {
        indenter: indenter.context("give the indenter's name with --indenter")?,
        x_mm: arguments.x_mm,
        y_mm: arguments.y_mm,
    };
    let files = super::files::expand(&arguments.csv)?;
    let curves = files.iter().map(|file| curve_of_csv(file, &place, &gel));
    Ok(curves.collect::<Result<_, _>>()?)
}

/// Prints the unknowns with their intervals, and warnings, for people.
fn tell(fit: &Fit, kinds: &str) -> Result<()> {
    let mut out = std::io::stderr().lock();
    writeln!(
        out,
        "{:36} {:>12} {:>12}   95 % confidence, from the Jacobian and the residuals' variance",
        "", "start", "found"
    )?;
    for unknown in &fit.unknowns {
        let [low, high] = unknown.interval_95;
        writeln!(
            out,
            "{:36} {:>12.5} {:>12.5}   {low:.5} to {high:.5}",
            unknown.name, unknown.start, unknown.value
        )?;
    }
    writeln!(
        out,
        "{} {kinds} samples, {} steps, residuals of {:.2} % of the largest value, condition {:.1}",
        fit.n_samples, fit.iterations, fit.noise_percent, fit.condition
    )?;
    for warning in &fit.warnings {
        writeln!(out, "warning: {warning}")?;
    }
    Ok(())
}
