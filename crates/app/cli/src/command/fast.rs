//! `twintac fast`: the twin without finite elements.

use anyhow::Result;
use twintac_fast::{GroupErrors, Judgement};
use twintac_run::SensorFile;
use twintac_run::fast::{FAST_GEL, FastSettings, Told, train_fast};

use crate::Program;
use crate::arguments::FastTrain;
use crate::output::print;

/// Trains, and prints how far the fast twin is from the solved gel.
pub(crate) fn train(arguments: &FastTrain, program: &Program) -> Result<()> {
    let sensor = SensorFile::read(&arguments.sensor)?;
    let mut settings = FastSettings::default();
    settings.n_lessons = arguments.lessons.unwrap_or(settings.n_lessons);
    settings.n_exams = arguments.exams.unwrap_or(settings.n_exams);
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
        "{}: {} presses taught; errors against the solved gel, % of each press's largest (simulated)",
        path.display(),
        found.n_taught
    ))?;
    print(&format!(
        "{:<28} {:>7} {:>8} {:>7} {:>7}",
        "", "frames", "nearest", "all", "force"
    ))?;
    print_group("held-out presses", &found.held_out.overall)?;
    print_judgement(found.exams_name(), &found.exams)?;
    if found.slides.overall.n_frames > 0 {
        print_group("the same, sliding and tilting", &found.slides.overall)?;
    }
    if let Some(strange) = &found.strange {
        print_strange(strange)?;
    }
    Ok(())
}

fn print_strange(found: &Told) -> Result<()> {
    let familiar = found.familiar_flagged_percent;
    print(&format!(
        "unlike all that was taught: errors, flagged %, how often they look stranger than held-out presses, of which {familiar:.1} % are flagged"
    ))?;
    for (kind, told) in &found.kinds {
        let errors = &told.errors;
        print(&format!(
            "{:<28} {:>7} {:>8.2} {:>7.2} {:>7.2} {:>9.1} {:>7.1}",
            format!("  {kind}"),
            errors.n_frames,
            errors.nearest_percent,
            errors.all_percent,
            errors.force_percent,
            told.flagged_percent,
            told.auroc_percent
        ))?;
    }
    print(&format!("{:<61} {:>17.1}", "  all", found.auroc_percent))
}

fn print_judgement(name: &str, found: &Judgement) -> Result<()> {
    print_group(name, &found.overall)?;
    for (shape, errors) in &found.by_shape {
        print_group(&format!("  {shape}"), errors)?;
    }
    for (depth_mm, errors) in &found.by_depth_mm {
        print_group(&format!("  {depth_mm} to {} mm deep", depth_mm + 1), errors)?;
    }
    print(&format!(
        "{:<36} {:>8.2}",
        "  read while nothing touches", found.untouched_percent
    ))?;
    for (novelty, errors) in &found.by_novelty {
        print_group(&format!("  {novelty} contacts"), errors)?;
    }
    for (place, errors) in &found.by_place {
        print_group(&format!("  {place} of the way to a corner"), errors)?;
    }
    Ok(())
}

fn print_group(name: &str, errors: &GroupErrors) -> Result<()> {
    print(&format!(
        "{name:<28} {:>7} {:>8.2} {:>7.2} {:>7.2}",
        errors.n_frames, errors.nearest_percent, errors.all_percent, errors.force_percent
    ))
}
