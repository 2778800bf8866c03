//! The table of the paper's experiments, from the kept `metrics.json` of
//! `twintac reproduce --paper`.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Figures, and what made them.
#[derive(Serialize, Deserialize)]
pub(super) struct Kept {
    pub(super) command: String,
    pub(super) commit: String,
    pub(super) metrics: Value,
}

/// What the paper has beside what was found here, and accuracies of classified shapes.
pub(super) fn table(kept: &Kept) -> String {
    let metrics = &kept.metrics;
    let number = |value: &Value, decimals: usize, unit: &str| {
        let number = value.as_f64();
        number.map_or("not given".to_owned(), |number| {
            format!("{number:.decimals$} {unit}")
        })
    };
    let twin = &metrics["twin"];
    let nearest = |figures: &Value| number(&figures["nearest_in_contact_percent"], 2, "%");
    let sensor = &metrics["sensor"];
    let mut rows = vec![
        (
            "error of the twin on test presses",
            "5.95 %",
            nearest(&twin["twin"]),
        ),
        (
            "error of the paper's network",
            "",
            nearest(&twin["variants"]["paper"]),
        ),
        (
            "error of the parametric baseline",
            "",
            nearest(&twin["baselines"]["kernel"]),
        ),
        (
            "residual of the fitted material, in force",
            "",
            number(&metrics["material"]["residual_percent"], 1, "%"),
        ),
        (
            "sensitivity under a 25 mm ball",
            "7.24 kPa/N",
            number(&sensor["sensitivity_kpa_per_n"], 2, "kPa/N"),
        ),
        ("linear to", "212 N", number(&sensor["linear_to_n"], 1, "N")),
        (
            "largest force",
            "212 N",
            number(&sensor["largest_force_n"], 1, "N"),
        ),
        (
            "smallest weight detected",
            "0.007 N",
            number(&sensor["smallest_step_n"], 4, "N"),
        ),
    ];
    let maps = metrics["maps"].as_array().cloned().unwrap_or_default();
    let mean = maps
        .iter()
        .filter_map(|map| map["difference_percent"].as_f64())
        .sum::<f64>()
        / maps.len().max(1) as f64;
    rows.push((
        "mean difference of twin and sensor, five shapes",
        "",
        format!("{mean:.1} %"),
    ));
    let lines = rows
        .into_iter()
        .map(|(name, paper, own)| format!("| {name} | {paper} | {own} |\n"));
    let results = metrics["shapes"].as_array();
    format!(
        "\n`{}`, commit {}, seed {}.\nThe bench is `emulated`, the twin `simulated`; the paper's figures are `real`, of another sensor.\n\n\
         | what | paper | here |\n|---|---|---|\n{}\n{}\n",
        kept.command,
        kept.commit,
        metrics["seed"],
        lines.collect::<String>(),
        shapes(results.map_or(&[], Vec::as_slice))
    )
}

/// A way to train, but for the bench's trials: whose simulated trials, how many of each shape, and
/// how presses are sampled.
type Way<'a> = (&'a str, u64, &'a str);

/// Accuracies: a row for each number of the bench's trials, a column for each way.
fn shapes(results: &[Value]) -> String {
    fn text<'a>(result: &'a Value, name: &str) -> &'a str {
        result[name].as_str().unwrap_or_default()
    }
    let count = |result: &Value, name: &str| result[name].as_u64().unwrap_or(0);
    let mut cells: BTreeMap<(u64, Way<'_>), String> = BTreeMap::new();
    for result in results {
        let way = (
            text(result, "simulated"),
            count(result, "simulated_trials"),
            text(result, "sampling"),
        );
        cells.insert((count(result, "real_trials"), way), accuracy(result));
    }
    let ways: BTreeSet<Way<'_>> = cells.keys().map(|(_, way)| *way).collect();
    let real: BTreeSet<u64> = cells.keys().map(|(real, _)| *real).collect();
    let head = ways.iter().map(|(whose, n, sampling)| {
        let what = match *whose {
            "none" => "alone".to_owned(),
            "paper_twin" => format!("{n} of the paper's twin"),
            _ => format!("{n} simulated"),
        };
        let over = if *sampling == "time" { ", over time" } else { "" };
        format!(" {what}{over} |")
    });
    let mut table = format!(
        "| presses of each shape on the bench |{}\n|---|{}\n",
        head.collect::<String>(),
        "---|".repeat(ways.len())
    );
    for real in real {
        let own = ways
            .iter()
            .map(|way| cells.get(&(real, *way)).map_or("", String::as_str));
        table += &format!(
            "| {real} |{}\n",
            own.map(|cell| format!(" {cell} |")).collect::<String>()
        );
    }
    table
}

/// Mean and standard deviation over seeds, %.
fn accuracy(result: &Value) -> String {
    let percent: Vec<f64> = result["accuracy_percent"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_f64)
        .collect();
    let n = percent.len().max(1) as f64;
    let mean = percent.iter().sum::<f64>() / n;
    let square: f64 = percent.iter().map(|value| (value - mean).powi(2)).sum();
    format!("{mean:.1} ± {:.1}", (square / (n - 1.0).max(1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accuracies_stand_by_their_trials() {
        let result = |real: u64, simulated: u64, whose: &str, percent: [f64; 3]| {
            serde_json::json!({
                "real_trials": real, "simulated": whose, "simulated_trials": simulated, "sampling": "load", "accuracy_percent": percent,
            })
        };
        let results = [
            result(20, 0, "none", [80.0, 82.0, 84.0]),
            result(0, 96, "twin", [90.0, 92.0, 94.0]),
            result(20, 96, "twin", [95.0, 95.0, 95.0]),
        ];
        let lines = shapes(&results);
        let lines: Vec<&str> = lines.lines().collect();
        assert_eq!(
            lines[0],
            "| presses of each shape on the bench | alone | 96 simulated |"
        );
        assert_eq!(
            lines[2..],
            ["| 0 |  | 92.0 ± 2.0 |", "| 20 | 82.0 ± 2.0 | 95.0 ± 0.0 |"]
        );
    }
}
