//! `twintac fast train`: trains a surrogate of the gel.

use anyhow::Result;
use twintac_fast::{Evaluation, GroupErrors};
use twintac_sensor::SensorFile;
use twintac_surrogate::{FastSettings, OodEvaluation, train_fast};
use twintac_tables::FAST_GEL;

use crate::Program;
use crate::arguments::FastTrain;
use crate::output::print;

/// Trains, and prints the errors of the surrogate against the FEM solution.
pub(crate) fn train(arguments: &FastTrain, program: &Program) -> Result<()> {
    let sensor = SensorFile::read(&arguments.sensor)?;
    let mut settings = FastSettings::default();
    settings.n_training_presses = arguments.training_presses.unwrap_or(settings.n_training_presses);
    settings.n_test_presses = arguments.test_presses.unwrap_or(settings.n_test_presses);
    settings.n_slides = arguments.slides.unwrap_or(settings.n_slides);
    settings.own_indenters = arguments.own_indenters;
    if let Some(steps) = arguments.steps {
        settings.train.n_steps = steps as usize;
    }
    let found = train_fast(
        &sensor,
        &arguments.out,
        &settings,
        arguments.seed,
        &program.caller()?,
    )?;
    if arguments.json {
        return print(&serde_json::to_string_pretty(&found)?);
    }
    let path = arguments.out.join(FAST_GEL);
    print(&format!(
        "{}: {} training presses; errors against the FEM solution, % of each press's largest value (simulated)",
        path.display(),
        found.n_trained_on
    ))?;
    print(&format!(
        "{:<NAME$} {:>7} {:>8} {:>7} {:>7} {:>12}",
        "", "frames", "nearest", "all", "force", "> 10 % off"
    ))?;
    print_group("held-out presses", &found.held_out.overall)?;
    print_evaluation(found.test_presses_name(), &found.test_presses)?;
    if found.slides.overall.is_some() {
        print_group("test presses that slide and tilt", &found.slides.overall)?;
    }
    if let Some(ood) = &found.out_of_distribution {
        print_ood(ood)?;
    }
    Ok(())
}

/// Width of the column of names.
const NAME: usize = 46;

fn print_ood(found: &OodEvaluation) -> Result<()> {
    print(&format!(
        "out of distribution: errors, flagged %, AUROC % of the OOD score; of the held-out presses, {} % are flagged",
        figure(found.in_distribution_flagged_percent, 1)
    ))?;
    for (kind, evaluation) in &found.kinds {
        print(&format!(
            "{} {:>9} {:>7}",
            group(&format!("  {kind}"), &evaluation.errors),
            figure(evaluation.flagged_percent, 1),
            figure(evaluation.auroc_percent, 1)
        ))?;
    }
    print(&format!("  all: {}", figure(found.auroc_percent, 1)))
}

fn print_evaluation(name: &str, found: &Evaluation) -> Result<()> {
    print_group(name, &found.overall)?;
    for (shape, errors) in &found.by_shape {
        print_group(&format!("  {shape}"), errors)?;
    }
    for (depth_mm, errors) in &found.by_depth_mm {
        print_group(&format!("  {depth_mm} to {} mm deep", depth_mm + 1), errors)?;
    }
    print(&format!(
        "{:<NAME$} {:>7} {:>8}",
        "  reading without contact",
        "",
        figure(found.untouched_percent, 2)
    ))?;
    for (kind, errors) in &found.by_ood_score {
        print_group(&format!("  {kind} contacts"), errors)?;
    }
    for (number, (place, errors)) in found.by_place.iter().enumerate() {
        let middle = if number == 0 { "middle, " } else { "" };
        print_group(&format!("  {middle}{place} of the way to a corner"), errors)?;
    }
    print_group("  within half the gel's height of the edge", &found.at_edge)
}

fn print_group(name: &str, found: &Option<GroupErrors>) -> Result<()> {
    print(&group(name, found))
}

/// A line of the table. A group without frames says so.
fn group(name: &str, found: &Option<GroupErrors>) -> String {
    let Some(errors) = found else {
        return format!(
            "{name:<NAME$} {:>7} {:>8} {:>7} {:>7} {:>12}",
            0, "none", "none", "none", "none"
        );
    };
    format!(
        "{name:<NAME$} {:>7} {:>8.2} {:>7.2} {:>7.2} {:>12}",
        errors.n_frames,
        errors.nearest_percent,
        errors.all_percent,
        errors.force_percent,
        figure(errors.off_by_a_tenth_percent, 0)
    )
}

/// A figure with this many decimals, or `none`.
fn figure(value: Option<f64>, decimals: usize) -> String {
    value.map_or("none".to_owned(), |value| format!("{value:.decimals$}"))
}
