//! What `xtask/results.toml` lists: rows of the overview of results, and parts of pages, with their
//! figures read from committed JSON.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context, Result};
use serde::Deserialize;

use super::places::{filled, values};
use crate::documents::read;
use crate::figures::Figure;

/// Where the rows are listed.
pub(super) const LIST: &str = "xtask/results.toml";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    result: Vec<Row>,
    part: Vec<Part>,
}

/// A row: what was measured, its figures, and what to compare them with. `figure` and `beside` have
/// places ([`super::places`]).
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    what: String,
    figure: String,
    #[serde(default)]
    beside: String,
    provenance: String,
    /// Committed files, by a short name.
    from: BTreeMap<String, String>,
    /// The page that says more, from `docs`.
    page: String,
    /// What it is called in README.md, if that has it as well.
    readme: Option<String>,
}

/// A part of a page, between `<!-- results: NAME -->` and `<!-- end -->`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Part {
    /// The page, from the root.
    pub(super) page: String,
    pub(super) name: String,
    /// Committed files, by a short name.
    from: BTreeMap<String, String>,
    /// The text, with places ([`super::places`]).
    text: String,
}

impl Part {
    /// The text with its places filled.
    pub(super) fn filled(&self, root: &Path) -> Result<String> {
        let filled = values(root, &self.from).and_then(|values| filled(&self.text, &values));
        let text = filled.with_context(|| format!("{LIST}: `{}` of {}", self.name, self.page))?;
        Ok(format!("\n{}\n\n", text.trim()))
    }
}

/// All parts of pages.
pub(super) fn parts(root: &Path) -> Result<Vec<Part>> {
    Ok(list(root)?.part)
}

/// The table of all rows.
pub(super) fn table(root: &Path, figures: &[Figure]) -> Result<String> {
    let mut text =
        "\n| what | figure | beside it | provenance | command, commit |\n|---|---|---|---|---|\n".to_owned();
    for row in &list(root)?.result {
        let line = || -> Result<String> {
            let made = made_by(figures, row)?;
            Ok(format!("{} {made} |\n", cells(root, row, &row.what, "")?))
        };
        text += &line().with_context(|| format!("{LIST}: `{}`", row.what))?;
    }
    Ok(text + "\n")
}

/// The rows for README.md.
pub(super) fn first_rows(root: &Path) -> Result<String> {
    let mut text = "\n| what | figure | beside it | provenance |\n|---|---|---|---|\n".to_owned();
    for row in &list(root)?.result {
        if let Some(what) = &row.readme {
            let cells = cells(root, row, what, "docs/").with_context(|| format!("{LIST}: `{what}`"))?;
            text += &format!("{cells}\n");
        }
    }
    Ok(text + "\n")
}

fn list(root: &Path) -> Result<List> {
    toml::from_str(&read(root, LIST)?).context(LIST)
}

/// A row without the command; `docs` is the way from the page to `docs`.
fn cells(root: &Path, row: &Row, what: &str, docs: &str) -> Result<String> {
    let values = values(root, &row.from)?;
    let Row { page, provenance, .. } = row;
    let (figure, beside) = (filled(&row.figure, &values)?, filled(&row.beside, &values)?);
    Ok(format!(
        "| [{what}]({docs}{page}) | {figure} | {beside} | {provenance} |"
    ))
}

/// The commands that made a row's figures, each with its commits.
fn made_by(figures: &[Figure], row: &Row) -> Result<String> {
    let mut commits: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for file in row.from.values() {
        let has_it = |own: &String| file == own || file.starts_with(&format!("{own}/"));
        let listed = figures.iter().find(|figure| figure.files.iter().any(has_it));
        let listed = listed.with_context(|| format!("{file} is not in {}", crate::figures::LIST))?;
        commits.entry(&listed.command).or_default().insert(&listed.commit);
    }
    let each = commits.iter().map(|(command, commits)| {
        let commits: Vec<&str> = commits.iter().copied().collect();
        format!("`{command}`, {}", commits.join(", "))
    });
    Ok(each.collect::<Vec<_>>().join("; "))
}
