//! `twintac calibrate`: the gel's material from measured presses.

use std::io::Write;
use std::sync::Arc;

use anyhow::{Context, Result};
use serde::Serialize;
use twintac_calibrate::{Curve, Fit, FitSettings, Parameter, fit};
use twintac_plot::{png, svg};
use twintac_recording::Provenance;
use twintac_simulate::{Gel, SimulateSettings};

use crate::arguments::Calibrate;
use twintac_run::cache::{write_file, write_json};
use twintac_run::calibration::{CsvPlace, Measured, material_file, of_csv, of_file, scene};
use twintac_run::progress;
use twintac_run::sensor_file::read_sensor;
use twintac_run::settings::RunSettings;

/// Pixels of the PNG for each of the plot's.
const PNG_SCALE: f64 = 2.0;

/// What `--json` prints, and `calibration.json` holds.
#[derive(Serialize)]
struct Answer<'a> {
    sensor: &'a str,
    /// Of the curves, without repetition.
    provenance: Vec<Provenance>,
    free: Vec<&'a str>,
    settings: &'a SimulateSettings,
    most_frames: usize,
    #[serde(flatten)]
    fit: &'a Fit,
}

/// Fits, and prints or writes what came of it.
pub(crate) fn run(arguments: &Calibrate) -> Result<()> {
    let described = read_sensor(&arguments.sensor)?;
    let names: Vec<&str> = arguments.free.iter().map(|name| name.trim()).collect();
    let free: Vec<Parameter> = names.iter().map(|name| Parameter::named(name)).collect();
    let settings = RunSettings::read(arguments.settings.as_deref())?.simulate;
    let gel = Gel::new(Arc::clone(&described.sensor), settings.clone());
    let (curves, mut provenance): (Vec<Curve>, Vec<Provenance>) =
        measured(arguments, &gel, described.import())?.into_iter().unzip();
    provenance.sort_unstable();
    provenance.dedup();
    let kinds: Vec<String> = provenance.iter().map(ToString::to_string).collect();
    let kinds = kinds.join(" and ");
    let fit_settings = FitSettings {
        most_frames: arguments.frames,
        ..FitSettings::default()
    };
    anyhow::ensure!(
        arguments.frames >= 2,
        "--frames is {}, expected 2 or more",
        arguments.frames
    );
    let bar = progress::bar("fitting", u64::from(fit_settings.max_iterations));
    let found = fit(&gel, &curves, &free, fit_settings, &mut |deviation| {
        bar.inc(1);
        bar.set_message(format!("deviation {:.3} %", 100.0 * deviation));
    })?;
    bar.finish_and_clear();
    let answer = Answer {
        sensor: &gel.sensor().name,
        provenance,
        free: names,
        settings: &settings,
        most_frames: arguments.frames,
        fit: &found,
    };
    let n = curves.len();
    let material = material_file(
        &found,
        &format!("{n} {kinds} curve{}", if n == 1 { "" } else { "s" }),
    )?;
    if let Some(folder) = &arguments.out {
        let plot = scene(&found, gel.sensor(), &kinds);
        let picture = png(&plot, PNG_SCALE)?;
        write_file(&folder.join("calibration.svg"), svg(&plot).as_bytes())?;
        write_file(&folder.join("calibration.png"), &picture)?;
        write_file(&folder.join("material.toml"), material.as_bytes())?;
        write_json(&folder.join("calibration.json"), &answer)?;
    }
    tell(&found, &kinds)?;
    if arguments.json {
        super::print(&serde_json::to_string_pretty(&answer)?)
    } else {
        super::print(material.trim_end())
    }
}

fn measured(arguments: &Calibrate, gel: &Gel, import: Option<std::path::PathBuf>) -> Result<Vec<Measured>> {
    if let Some(path) = &arguments.curves {
        return of_file(path, gel, import);
    }
    let place = CsvPlace {
        indenter: arguments
            .indenter
            .clone()
            .context("give the indenter's name with --indenter")?,
        x_mm: arguments.x_mm,
        y_mm: arguments.y_mm,
    };
    let files = super::files::expand(&arguments.csv)?;
    files
        .iter()
        .map(|file| of_csv(file, &place, gel.sensor()))
        .collect()
}

/// The unknowns with their intervals, and what to doubt, for people.
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
