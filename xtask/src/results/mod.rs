//! The tables of results, written from committed figures: the overview (`docs/results.md`, its
//! first rows in README.md), parts of pages, the paper's experiments, and which sources made what.

mod overview;
mod paper;
mod places;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::documents::{read, replace_part};
use crate::figures;
use crate::git::git;
use paper::Kept;

const KEPT: &str = "docs/results/metrics.json";
const COMMAND: &str = "twintac reproduce --paper";

/// Keeps a `metrics.json` of this commit, where one is given; writes the tables, and fails where
/// figures are of older code and nothing says so.
pub fn write(root: &Path, metrics: Option<&str>) -> Result<()> {
    if let Some(path) = metrics {
        keep(root, path)?;
    }
    for (page, text) in &fresh(root)? {
        fs::write(root.join(page), text).with_context(|| format!("writing {page}"))?;
    }
    figures::check(root, &figures::read(root)?)
}

/// The pages are as [`write`] would leave them.
pub fn is_fresh(root: &Path) -> Result<()> {
    for (page, text) in &fresh(root)? {
        ensure!(
            read(root, page)? == *text,
            "{page} is not what the committed figures, {} and {} say: run `cargo xtask results`",
            figures::LIST,
            overview::LIST
        );
    }
    Ok(())
}

fn keep(root: &Path, path: &str) -> Result<()> {
    let text = fs::read_to_string(path).with_context(|| format!("reading {path}"))?;
    let metrics: Value = serde_json::from_str(&text).with_context(|| format!("reading {path}"))?;
    ensure!(
        metrics["effort"] == "full",
        "{path} was made with --quick: its figures show nothing"
    );
    ensure!(
        git(root, &["status", "--porcelain"])?.is_empty(),
        "something is not committed: nobody could make these figures again"
    );
    let kept = Kept {
        command: COMMAND.to_owned(),
        commit: git(root, &["rev-parse", "--short", "HEAD"])?,
        metrics,
    };
    fs::write(root.join(KEPT), serde_json::to_string_pretty(&kept)? + "\n")?;
    figures::are_made_anew(root, KEPT, &kept.commit)
}

/// Each page, and its text with the figures written anew.
fn fresh(root: &Path) -> Result<BTreeMap<String, String>> {
    let figures = figures::read(root)?;
    let kept: Kept = serde_json::from_str(&read(root, KEPT)?).with_context(|| format!("reading {KEPT}"))?;
    let mut pages = BTreeMap::new();
    let mut write = |page: &str, part: &str, text: &str| -> Result<()> {
        if !pages.contains_key(page) {
            pages.insert(page.to_owned(), read(root, page)?);
        }
        let own = pages.entry(page.to_owned()).or_default();
        replace_part(own, &format!("results: {part}"), text).with_context(|| page.to_owned())
    };
    write("README.md", "readme", &overview::first_rows(root)?)?;
    write("docs/results.md", "overview", &overview::table(root, &figures)?)?;
    write("docs/results/paper.md", "paper", &paper::table(&kept))?;
    write("docs/results/sources.md", "sources", &figures::table(&figures))?;
    for part in overview::parts(root)? {
        write(&part.page, &part.name, &part.filled(root)?)?;
    }
    Ok(pages)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_made_quickly_is_not_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("metrics.json");
        fs::write(&path, r#"{"effort": "quick"}"#).unwrap();
        let error = write(&crate::root(), path.to_str()).unwrap_err().to_string();
        assert!(error.contains("--quick"), "{error}");
    }
}
