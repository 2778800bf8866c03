//! The pages for people, and the records for programs.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result};
use serde_json::{Value, json};

use crate::files::write_whole;
use crate::rung::{Effort, Outcome, Rung, number};

/// Writes a test's page, plots and record, and returns the record.
pub(crate) fn write(folder: &Path, rung: &Rung, outcome: &Outcome, effort: Effort) -> Result<Value> {
    let is_quick = effort == Effort::Quick;
    let command = format!(
        "cargo xtask verify {}{}",
        rung.name,
        if is_quick { " --quick" } else { "" }
    );
    let mut page = format!("# {} {}\n\n", rung.number, rung.title);
    let _ = writeln!(
        page,
        "Made by `{command}`{}.\n",
        if is_quick {
            ", a smaller version of the test"
        } else {
            ""
        }
    );
    let _ = writeln!(page, "{}\n", outcome.done);
    let _ = writeln!(page, "| figure | value | limit | holds |\n|---|---:|---:|---|");
    for figure in &outcome.figures {
        let _ = writeln!(
            page,
            "| {} | {} {} | {} | {} |",
            figure.name,
            number(figure.value),
            figure.unit,
            figure.limit,
            if figure.holds { "yes" } else { "**no**" }
        );
    }
    for plot in &outcome.plots {
        let file = format!("{}-{}.png", rung.name, plot.name);
        let _ = write!(page, "\n![{}]({file})\n\n{}\n", plot.scene.name, plot.caption);
        write_whole(&folder.join(file), &twintac_plot::png(&plot.scene, 2.0)?)?;
    }
    write_whole(&folder.join(format!("{}.md", rung.name)), page.as_bytes())?;
    let record = json!({
        "rung": rung.number,
        "name": rung.name,
        "title": rung.title,
        "command": command,
        "quick": is_quick,
        "done": outcome.done,
        "holds": outcome.holds(),
        "figures": outcome.figures,
    });
    let mut text = serde_json::to_string_pretty(&record)?;
    text.push('\n');
    write_whole(&folder.join(format!("{}.json", rung.name)), text.as_bytes())?;
    Ok(record)
}

/// Writes the table of all tests that have a record in the folder.
pub(crate) fn write_index(folder: &Path) -> Result<()> {
    let mut records = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "json") {
            let text = std::fs::read(&path).with_context(|| format!("reading {}", path.display()))?;
            let record: Value =
                serde_json::from_slice(&text).with_context(|| format!("reading {}", path.display()))?;
            records.push(record);
        }
    }
    records.sort_by_key(|record| record["rung"].as_u64());
    let mut page = String::from(
        "# Verification\n\n\
         The soft-body solver is checked by a series of verification tests,\n\
         from what must be exact to what is only likely.\n\
         Each figure has a limit.\n\
         The title of a test links to its page, with the setup, the reference and plots.\n\
         The last column says whether the full test gave the figures, or a smaller version of it (`--quick`).\n\n\
         `cargo xtask verify` runs all tests again, and ends with an error if a limit does not hold.\n\
         `cargo xtask verify hertz` runs one test, `--quick` a smaller version, and `--json` prints records.\n\
         [Results](../results/soft-body.md) explains the limits that do not hold.\n\n\
         | test | title | figure | value | limit | holds | run |\n|---:|---|---|---:|---:|---|---|\n",
    );
    for record in &records {
        let text = |name: &str| record[name].as_str().unwrap_or_default().to_owned();
        let mut start = format!("{} | [{}]({}.md)", record["rung"], text("title"), text("name"));
        for figure in record["figures"].as_array().into_iter().flatten() {
            let Some((sign, limit)) = limit(&figure["limit"]) else {
                continue;
            };
            let _ = writeln!(
                page,
                "| {start} | {} | {} {} | {sign} {} | {} | {} |",
                figure["name"].as_str().unwrap_or_default(),
                figure["value"].as_f64().map_or("–".into(), number),
                figure["unit"].as_str().unwrap_or_default(),
                number(limit),
                if figure["holds"] == true { "yes" } else { "**no**" },
                if record["quick"] == true { "quick" } else { "full" },
            );
            start = " | ".into();
        }
    }
    write_whole(&folder.join("README.md"), page.as_bytes())
}

fn limit(limit: &Value) -> Option<(&'static str, f64)> {
    let at_most = limit["at_most"].as_f64().map(|limit| ("≤", limit));
    at_most.or_else(|| limit["at_least"].as_f64().map(|limit| ("≥", limit)))
}
