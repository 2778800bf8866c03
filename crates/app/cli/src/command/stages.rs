//! The stages of a run as commands of their own.

use anyhow::{Context, Result};
use twintac_model::{UnseenEvaluation, evaluate_elsewhere, sensor_of_model};
use twintac_run::{Metrics, Run, read_recordings};

use super::files::{expand, import_aloud, rename};
use crate::Program;
use crate::arguments::{Align, Evaluate, Report, Train};
use crate::output::{percent, print};
use crate::progress::Bars;

/// Runs all stages after the recordings, and prints the headline figure.
pub(crate) fn finish(run: &Run) -> Result<()> {
    let metrics = run.finish()?;
    print_headline(run, &metrics)
}

/// `twintac align`: simulates the locations of a run's presses, fits the unknowns of the bench, and
/// pairs frames.
pub(crate) fn align(arguments: &Align, program: &Program) -> Result<()> {
    let run = Run::open(&arguments.run, program.caller()?)?;
    run.simulate()?;
    Ok(run.pair()?)
}

/// `twintac train`.
pub(crate) fn train(arguments: &Train, program: &Program) -> Result<()> {
    Ok(Run::open(&arguments.run, program.caller()?)?.train()?)
}

/// `twintac evaluate`: evaluates a run's twin on its test presses, or a model on other recordings.
pub(crate) fn evaluate(arguments: &Evaluate, program: &Program) -> Result<()> {
    if let Some(folder) = &arguments.run {
        let run = Run::open(folder, program.caller()?)?;
        let metrics = run.evaluate()?;
        if arguments.json {
            return print(&serde_json::to_string_pretty(&metrics)?);
        }
        return print_headline(&run, &metrics);
    }
    let model = arguments.model.as_ref();
    let model = model.context("give a model with --model, or a run with --run")?;
    let files = expand(&arguments.recordings)?;
    let mut recording = match &arguments.import {
        Some(import) => import_aloud(import, &files)?,
        None => read_recordings(&files)?,
    };
    let recorded_as = arguments.recorded_as.as_deref();
    rename(&mut recording, recorded_as, &sensor_of_model(model)?)?;
    let found = evaluate_elsewhere(model, &recording, &Bars::default())?;
    if arguments.json {
        return print(&serde_json::to_string_pretty(&found)?);
    }
    print(&unseen(&found))
}

/// `twintac report`.
pub(crate) fn report(arguments: &Report, program: &Program) -> Result<()> {
    Ok(Run::open(&arguments.run, program.caller()?)?.report()?)
}

fn print_headline(run: &Run, metrics: &Metrics) -> Result<()> {
    print(&headline(metrics))?;
    print(&format!("report  {}", run.report_path().display()))?;
    print(&format!("model   {}", run.model_folder().display()))
}

fn headline(metrics: &Metrics) -> String {
    let mut rows = vec![("twin".to_owned(), &metrics.twin.overall)];
    let by_file = metrics.twin.by_file.iter();
    rows.extend(by_file.map(|(file, figures)| (format!("  {file}"), figures)));
    let all_taxels = metrics.twin_all_taxels.iter();
    rows.extend(all_taxels.map(|figures| ("twin, every taxel".to_owned(), figures)));
    let polynomial = metrics.baselines.polynomial.iter();
    rows.extend(polynomial.map(|figures| ("static polynomial".to_owned(), figures)));
    let kernel = metrics.baselines.kernel.iter();
    rows.extend(kernel.map(|figures| ("parametric baseline".to_owned(), figures)));
    rows.push(("zero".to_owned(), &metrics.baselines.zero));
    let repeatability = metrics.repeatability.iter();
    rows.extend(repeatability.map(|figures| ("repeated press".to_owned(), figures)));

    let width = rows
        .iter()
        .map(|(name, _)| name.chars().count())
        .max()
        .unwrap_or(0);
    let mut lines = vec![
        format!(
            "{} ({} data), {} held-out presses, `{}`",
            metrics.sensor, metrics.provenance, metrics.held_out_presses, metrics.variant
        ),
        format!("{:<width$}  {:>8}  {:>8}", "", "nearest", "all"),
    ];
    lines.extend(rows.iter().map(|(name, figures)| {
        format!(
            "{name:<width$}  {}  {}",
            percent(figures.nearest_in_contact_percent),
            percent(figures.all_percent)
        )
    }));
    let beyond = metrics.twin.frames_not_simulated;
    if beyond > 0 {
        lines.push(format!(
            "{:.1} % of the frames are deeper than the simulation; the last simulated pressures are used for them.",
            100.0 * beyond as f64 / metrics.twin.frames.max(beyond) as f64
        ));
    }
    lines.push(metrics.definition.clone());
    lines.join("\n")
}

fn unseen(found: &UnseenEvaluation) -> String {
    let figures = &found.twin.overall;
    let mut lines = vec![
        format!(
            "{} presses ({} data), `{}`",
            found.presses, found.provenance, found.variant
        ),
        format!(
            "nearest in contact {}, all {}",
            percent(figures.nearest_in_contact_percent),
            percent(figures.all_percent)
        ),
        format!(
            "without recalibration: nearest in contact {}",
            percent(found.uncalibrated.nearest_in_contact_percent)
        ),
    ];
    for contact in &found.contact {
        let height = &contact.contact_offset_mm;
        let n_used = contact.used.len();
        lines.push(format!(
            "{}: contact height {:+.3} mm ± {:.3}, from its first {n_used} presses, which are not scored",
            contact.file, height.value, height.uncertainty
        ));
        lines.extend(contact.doubts.iter().cloned());
    }
    lines.push(found.definition.clone());
    lines.join("\n")
}
