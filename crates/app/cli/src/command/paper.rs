//! `twintac reproduce --paper`: the paper's experiments on the emulated bench.

use std::path::Path;

use anyhow::Result;
use twintac_paper::{Effort, Paper, PaperMetrics};

use crate::Program;
use crate::arguments::Reproduce;
use crate::output::{percent, print};

pub(super) fn run(arguments: &Reproduce, program: &Program) -> Result<()> {
    let effort = if arguments.quick {
        Effort::Quick
    } else {
        Effort::Full
    };
    let out = arguments.out.as_deref().unwrap_or(Path::new("runs/paper"));
    let paper = Paper::start(out, effort, arguments.start.seed, program.caller()?)?;
    let found = paper.finish()?;
    if arguments.json {
        return print(&serde_json::to_string_pretty(&found)?);
    }
    print(&text(&found))?;
    print(&format!("report  {}", paper.report_path().display()))
}

fn text(found: &PaperMetrics) -> String {
    let twin = &found.twin;
    let mut lines = vec![
        format!("{} data, seed {}", found.provenance, found.seed),
        format!(
            "twin                  {} on {} held-out presses",
            percent(twin.twin.overall.nearest_in_contact_percent),
            twin.held_out_presses
        ),
    ];
    if let Some(paper) = twin.variants.get("paper") {
        let error = percent(paper.nearest_in_contact_percent);
        lines.push(format!("the paper's network   {error}"));
    }
    let left = percent(Some(found.material.residual_percent));
    lines.push(format!("residual of the gel   {left} of the largest force"));
    if let Some(sensitivity) = found.sensor.sensitivity_kpa_per_n {
        lines.push(format!("sensitivity           {sensitivity:6.2} kPa/N"));
    }
    for result in &found.shapes {
        let accuracies = &result.accuracy_percent;
        lines.push(format!(
            "shapes, {:2} real trials and {:3} simulated ({}), over {}: {:.1} %",
            result.mixture.real_trials,
            result.mixture.simulated_trials,
            result.mixture.simulated.name(),
            result.mixture.sampling,
            accuracies.iter().sum::<f64>() / accuracies.len() as f64
        ));
    }
    lines.join("\n")
}
