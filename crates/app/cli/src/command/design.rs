//! `twintac design`: compares designs of a sensor before one is cast.

use anyhow::Result;
use twintac_design::{Design, Designs, Figures, Measure, Plan, Wishes, search};
use twintac_sensor::SensorFile;

use crate::Program;
use crate::arguments::Design as Arguments;
use crate::output::print;
use crate::progress::say;

/// Most designs that are printed.
const MOST_ROWS: usize = 20;

/// Evaluates the designs, and prints the Pareto front.
pub(super) fn run(arguments: &Arguments, program: &Program) -> Result<()> {
    let sensor = match &arguments.sensor {
        Some(path) => SensorFile::read(path)?,
        None => SensorFile::phystac()?,
    };
    let plan = match arguments.grid {
        Some(n_values) => Plan::Grid {
            n_values: n_values as usize,
        },
        None => Plan::LatinHypercube {
            n_designs: arguments.designs.unwrap_or(50) as usize,
            seed: arguments.seed.unwrap_or(1),
        },
    };
    let usual = Measure::default();
    let measure = Measure {
        force_n: arguments.force_n.unwrap_or(usual.force_n),
        ball_radius_mm: arguments.ball_radius_mm.unwrap_or(usual.ball_radius_mm),
        noise_kpa: arguments.noise_kpa,
        max_nodes: arguments.nodes.unwrap_or(usual.max_nodes),
    };
    let mut wishes = Wishes {
        needs: arguments.need.clone(),
        ..Wishes::default()
    };
    if !arguments.goal.is_empty() {
        wishes.goals.clone_from(&arguments.goal);
    }
    let found = search(
        &sensor,
        &arguments.vary,
        plan,
        &measure,
        &wishes,
        &arguments.out,
        &program.caller()?,
    )?;
    let best = found.best(&wishes);
    let refused: Vec<&Design> = found
        .designs
        .iter()
        .filter(|design| design.refused().is_some())
        .collect();
    if let Some(first) = refused.first() {
        say(&format!(
            "{} of {} designs cannot be evaluated; the first, {}: {}",
            refused.len(),
            found.designs.len(),
            first.number,
            first.refused().unwrap_or_default()
        ));
    }
    if best.is_none() {
        say("no design meets the requirements (--need): best.toml is not written");
    }
    if arguments.json {
        return print(&serde_json::to_string_pretty(&found)?);
    }
    print_front(&found, &wishes, best)?;
    if let Some(best) = best {
        print(&format!(
            "{}: design {best} (simulated)",
            arguments.out.join("best.toml").display()
        ))?;
    }
    Ok(())
}

/// Prints the designs of the Pareto front with their variables and goals; the best one is marked.
fn print_front(found: &Designs, wishes: &Wishes, best: Option<usize>) -> Result<()> {
    let front = found.front(wishes);
    let names = found.fields.iter().map(String::as_str);
    let names: Vec<&str> = names.chain(wishes.goals.iter().map(|goal| goal.name())).collect();
    print(&format!("{:>8} {}", "design", names.join(" ")))?;
    let shown = found
        .evaluated()
        .filter(|(design, _)| front.contains(&design.number) || best == Some(design.number));
    let shown: Vec<(&Design, &Figures)> = shown.collect();
    for (index, (design, figures)) in shown.iter().enumerate() {
        let is_best = best == Some(design.number);
        if index >= MOST_ROWS && !is_best {
            continue;
        }
        let goals = wishes.goals.iter().map(|goal| goal.of(figures));
        let values = design.values.iter().copied().map(Some).chain(goals);
        let cells: Vec<String> = values
            .zip(&names)
            .map(|(value, name)| cell(value, name))
            .collect();
        let number = format!("{}{}", if is_best { "*" } else { "" }, design.number);
        print(&format!("{number:>8} {}", cells.join(" ")))?;
    }
    if shown.len() > MOST_ROWS {
        print(&format!(
            "{MOST_ROWS} of {} Pareto-optimal designs; designs.csv has all",
            shown.len()
        ))?;
    }
    Ok(())
}

/// A number, as wide as the name of its column.
fn cell(value: Option<f64>, name: &str) -> String {
    let width = name.len();
    value.map_or(format!("{:>width$}", "none"), |value| {
        format!("{value:>width$.4}")
    })
}
