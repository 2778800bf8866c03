//! `twintac cross-validate`.

use anyhow::Result;
use twintac_run::{CrossValidation, CrossValidationPlan, Run, Spread};

use crate::arguments::CrossValidate;
use crate::caller::caller;
use crate::output::print;

pub(crate) fn run(arguments: &CrossValidate) -> Result<()> {
    let run = Run::open(&arguments.run, caller()?)?;
    let plan = CrossValidationPlan {
        held_out: arguments.held_out.clone(),
        seeds: arguments.seeds,
        ablation: arguments.ablation,
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
        format!("{:<width$}  {:<14}  {:<14}", "held out", "twin", "fitted curve"),
    ];
    for row in &found.rows {
        let kernel = row.kernel.as_ref().map_or_else(String::new, spread);
        lines.push(
            format!("{:<width$}  {:<14}  {kernel}", row.name(), spread(&row.twin))
                .trim_end()
                .to_owned(),
        );
        if row.without.is_none() && row.variants.len() > 1 {
            let variants = row.variants.iter();
            lines.extend(variants.map(|(variant, own)| format!("  {:<20}  {}", variant.name(), spread(own))));
        }
        if row.frames_not_simulated_percent > 0.0 {
            lines.push(format!(
                "  {:.1} % of these frames lie deeper than the simulation went",
                row.frames_not_simulated_percent
            ));
        }
    }
    lines.join("\n")
}
