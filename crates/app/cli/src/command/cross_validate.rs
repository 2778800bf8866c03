//! `twintac cross-validate`.

use anyhow::Result;
use twintac_run::{CertaintySpread, CrossValidation, CrossValidationPlan, Run, Spread};

use crate::Program;
use crate::arguments::CrossValidate;
use crate::output::print;

pub(crate) fn run(arguments: &CrossValidate, program: &Program) -> Result<()> {
    let run = Run::open(&arguments.run, program.caller()?)?;
    let plan = CrossValidationPlan {
        held_out: arguments.held_out.clone(),
        seeds: arguments.seeds,
        ablation: arguments.ablation,
        intervals: arguments.intervals,
    };
    let found = run.cross_validate(&plan)?;
    if arguments.json {
        return print(&serde_json::to_string_pretty(&found)?);
    }
    print(&table(&found, arguments.seeds))
}

fn table(found: &CrossValidation, seeds: u64) -> String {
    let spread =
        |spread: &Spread| format!("{:5.2} ± {:4.2} %", spread.mean_percent, spread.deviation_percent);
    let names = found.rows.iter().map(|row| row.name().chars().count());
    let width = names.max().unwrap_or(0);
    let mut lines = vec![
        format!(
            "{} ({} data), {seeds} seeds: mean ± standard deviation; nearest taxel, frames in contact",
            found.sensor, found.provenance
        ),
        format!(
            "{:<width$}  {:<14}  {:<14}",
            "held out", "twin", "parametric baseline"
        ),
    ];
    for row in &found.rows {
        let twin = row.twin.as_ref().map_or_else(|| "none".to_owned(), spread);
        let kernel = row.kernel.as_ref().map_or_else(String::new, spread);
        lines.push(
            format!("{:<width$}  {twin:<14}  {kernel}", row.name())
                .trim_end()
                .to_owned(),
        );
        if row.without.is_none() && row.variants.len() > 1 {
            let variants = row.variants.iter();
            lines.extend(variants.map(|(variant, own)| format!("  {:<20}  {}", variant.name(), spread(own))));
        }
        lines.extend(sureness(&row.certainty));
        if let Some(percent) = row.frames_not_simulated_percent.filter(|percent| *percent > 0.0) {
            lines.push(format!(
                "  {percent:.1} % of these frames are deeper than the simulation"
            ));
        }
    }
    lines.join("\n")
}

/// Coverage of the 90 % intervals, and AUROC of the OOD score.
fn sureness(found: &CertaintySpread) -> Vec<String> {
    let spread = |spread: &Spread| format!("{:.1} ± {:.1} %", spread.mean_percent, spread.deviation_percent);
    let mut lines = Vec::new();
    if let (Some(covered), Some(in_contact), Some(width), Some(flagged)) = (
        &found.covered,
        &found.covered_in_contact,
        &found.width_in_contact,
        &found.flagged,
    ) {
        lines.push(format!(
            "  90 % intervals cover {} of the readings, {} in contact; there they are {} wide, and {} of the frames are flagged as out of distribution",
            spread(covered),
            spread(in_contact),
            spread(width),
            spread(flagged)
        ));
    }
    if let Some(ood_detection) = &found.ood_detection {
        lines.push(format!("  OOD detection: AUROC {}", spread(ood_detection)));
    }
    lines
}
