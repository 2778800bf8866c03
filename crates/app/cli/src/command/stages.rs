//! The stages as commands of their own.

use anyhow::{Context, Result};
use twintac_recording::Recording;

use super::files::expand;
use crate::arguments::{Align, Evaluate, Report, Train};
use twintac_run::metrics::Metrics;
use twintac_run::run::Run;
use twintac_run::stages::evaluation::{UnseenEvaluation, evaluate_elsewhere};
use twintac_run::stages::recordings::import_files;

/// Everything after the recordings; prints the headline.
pub(crate) fn finish(run: &Run) -> Result<()> {
    run.mesh()?;
    run.simulate()?;
    run.pair()?;
    run.train()?;
    run.evaluate()?;
    run.report(&super::command_line())?;
    print_headline(run)
}

/// `twintac align`: simulates the places of a run's presses, fits the bench, and pairs frames.
pub(crate) fn align(arguments: &Align) -> Result<()> {
    let run = Run::open(&arguments.run)?;
    run.simulate()?;
    run.pair()
}

/// `twintac train`.
pub(crate) fn train(arguments: &Train) -> Result<()> {
    Run::open(&arguments.run)?.train()
}

/// `twintac evaluate`: a run's held-out presses, or a model on recordings from elsewhere.
pub(crate) fn evaluate(arguments: &Evaluate) -> Result<()> {
    if let Some(folder) = &arguments.run {
        let run = Run::open(folder)?;
        run.evaluate()?;
        if arguments.json {
            let (_, metrics) = run.evaluation()?;
            return super::print(&serde_json::to_string_pretty(&metrics)?);
        }
        return print_headline(&run);
    }
    let model = arguments
        .model
        .as_ref()
        .context("give a model with --model, or a run with --run")?;
    let files = expand(&arguments.recordings)?;
    let recording = match &arguments.import {
        Some(import) => import_files(import, &files)?.0,
        None => read_presses(&files)?,
    };
    let found = evaluate_elsewhere(model, &recording)?;
    if arguments.json {
        return super::print(&serde_json::to_string_pretty(&found)?);
    }
    super::print(&unseen(&found))
}

/// `twintac report`.
pub(crate) fn report(arguments: &Report) -> Result<()> {
    Run::open(&arguments.run)?.report(&super::command_line())
}

fn read_presses(files: &[std::path::PathBuf]) -> Result<Recording> {
    let mut all: Option<Recording> = None;
    for file in files {
        if file.extension().is_none_or(|extension| extension != "parquet") {
            anyhow::bail!(
                "{} is no Parquet file; say with --import how to read it",
                file.display()
            );
        }
        let next = Recording::read_parquet(file)?;
        match &mut all {
            None => all = Some(next),
            Some(all) => all.append(next).with_context(|| file.display().to_string())?,
        }
    }
    all.context("there are no recordings")
}

fn print_headline(run: &Run) -> Result<()> {
    let (_, metrics) = run.evaluation()?;
    super::print(&headline(&metrics))?;
    super::print(&format!("report  {}", run.folder.join("report.html").display()))?;
    super::print(&format!("model   {}", run.folder.join("model").display()))
}

fn headline(metrics: &Metrics) -> String {
    let mut rows = vec![("twin".to_owned(), &metrics.twin.overall)];
    let by_file = metrics.twin.by_file.iter();
    rows.extend(by_file.map(|(file, figures)| (format!("  {file}"), figures)));
    let all_taxels = metrics.twin_all_taxels.iter();
    rows.extend(all_taxels.map(|figures| ("twin, every taxel".to_owned(), figures)));
    let polynomial = metrics.baselines.polynomial.iter();
    rows.extend(polynomial.map(|figures| ("static polynomial".to_owned(), figures)));
    rows.push(("zero".to_owned(), &metrics.baselines.zero));
    let repeatability = metrics.repeatability.iter();
    rows.extend(repeatability.map(|figures| ("repeatability".to_owned(), figures)));

    let width = rows
        .iter()
        .map(|(name, _)| name.chars().count())
        .max()
        .unwrap_or(0);
    let mut lines = vec![
        format!(
            "{} ({} data), {} presses that the twin never saw, `{}`",
            metrics.sensor, metrics.provenance, metrics.held_out_presses, metrics.variant
        ),
        format!("{:<width$}  {:>8}  {:>8}", "", "nearest", "all"),
    ];
    lines.extend(rows.iter().map(|(name, figures)| {
        format!(
            "{name:<width$}  {:6.2} %  {:6.2} %",
            figures.nearest_in_contact_percent, figures.all_percent
        )
    }));
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
            "nearest in contact {:6.2} %, all {:6.2} %",
            figures.nearest_in_contact_percent, figures.all_percent
        ),
        format!(
            "with contact heights as at training: nearest in contact {:6.2} %",
            found.uncalibrated.nearest_in_contact_percent
        ),
    ];
    for contact in &found.contact {
        let height = &contact.contact_offset_mm;
        let n_used = contact.used.len();
        lines.push(format!(
            "{}: contact {:+.3} mm ± {:.3}, from its first {n_used} presses, which are not scored",
            contact.file, height.value, height.uncertainty
        ));
        lines.extend(contact.doubts.iter().cloned());
    }
    lines.push(found.definition.clone());
    lines.join("\n")
}
