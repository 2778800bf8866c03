//! The committed figures: which sources made each, and whether those are still the same
//! (`xtask/figures.toml`).

mod change;
mod script;
mod source;

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;

use crate::git::git;
use crate::layers::Graph;

/// Where the figures are listed.
pub const LIST: &str = "xtask/figures.toml";

/// Folders that figures are in, and what the names of figures end with; pages and pictures are
/// written with them.
const FOLDERS: [&str; 1] = ["docs"];
const FIGURES: [&str; 4] = [".json", ".csv", ".png", ".svg"];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    figure: Vec<Figure>,
}

/// Files that one command writes.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// From the root of the checkout; folders with all in them.
    pub files: Vec<String>,
    /// What writes them.
    pub command: String,
    /// Whose sources wrote them.
    pub commit: String,
    /// Packages whose code makes them, with all that these are built with.
    #[serde(default)]
    pub packages: Vec<String>,
    /// Files and folders that do as well.
    #[serde(default)]
    pub paths: Vec<String>,
    /// Why they are kept although the code has changed since.
    pub older: Option<String>,
    /// What makes pictures again, for `bash`.
    pub remake: Option<String>,
}

/// All figures. Each of the folders is listed, with the commit that it has itself, if it has one.
pub fn read(root: &Path) -> Result<Vec<Figure>> {
    let text = std::fs::read_to_string(root.join(LIST)).with_context(|| format!("reading {LIST}"))?;
    let List { figure: figures } = toml::from_str(&text).context(LIST)?;
    let mut listed = BTreeSet::new();
    for figure in &figures {
        for file in &figure.files {
            ensure!(listed.insert(file.as_str()), "{LIST}: `{file}` is listed twice");
            ensure!(root.join(file).exists(), "{LIST}: `{file}` does not exist");
            if let Some(own) = own_commit(&root.join(file))? {
                ensure!(
                    own == figure.commit,
                    "{LIST}: `{file}` is listed as of {}, and is of {own} itself",
                    figure.commit
                );
            }
        }
    }
    let arguments = [&["ls-files", "--"], &FOLDERS[..]].concat();
    for file in git(root, &arguments)?.lines() {
        let is_figure = FIGURES.iter().any(|ending| file.ends_with(ending));
        let is_listed = Path::new(file)
            .ancestors()
            .any(|path| path.to_str().is_some_and(|path| listed.contains(path)));
        ensure!(
            !is_figure || is_listed,
            "`{file}` is not in {LIST}: nobody knows what made it"
        );
    }
    Ok(figures)
}

/// The commit that a figure says it is of.
fn own_commit(file: &Path) -> Result<Option<String>> {
    if file.extension().is_none_or(|extension| extension != "json") {
        return Ok(None);
    }
    let text = std::fs::read_to_string(file)?;
    let value: serde_json::Value =
        serde_json::from_str(&text).with_context(|| format!("reading {}", file.display()))?;
    Ok(value["commit"].as_str().map(str::to_owned))
}

/// Fails where code that makes a figure has changed since, and nothing says so; and where something
/// says so without need.
pub fn check(root: &Path, figures: &[Figure]) -> Result<()> {
    if git(root, &["rev-parse", "--is-shallow-repository"])? == "true" {
        eprintln!("note: this clone has no history; whether figures are older than the code is not known");
        return Ok(());
    }
    let graph = Graph::read(root)?;
    let mut wrong = Vec::new();
    for figure in figures {
        let Figure { commit, command, .. } = figure;
        let name = figure.files.join(", ");
        let changed = figure.changed(root, &graph).with_context(|| name.clone())?;
        match (&figure.older, changed.as_slice()) {
            (None, [first, ..]) => wrong.push(format!(
                "{name}: of {commit}; {} files that make it have changed since, `{first}` first. Make it again with `{command}`, or say why it is \
                 kept: `older = \"…\"` in {LIST}",
                changed.len()
            )),
            (Some(_), []) => wrong.push(format!(
                "{name}: `older` in {LIST}, but what makes it is as it was at {commit}"
            )),
            _ => {}
        }
    }
    if !wrong.is_empty() {
        bail!("figures and the code that makes them:\n{}", wrong.join("\n"));
    }
    Ok(())
}

/// Notes in the list that a file has been made by the sources of a commit.
pub fn are_made_anew(root: &Path, file: &str, commit: &str) -> Result<()> {
    let path = root.join(LIST);
    let text = std::fs::read_to_string(&path).with_context(|| format!("reading {LIST}"))?;
    Ok(std::fs::write(path, noted(&text, file, commit))?)
}

fn noted(text: &str, file: &str, commit: &str) -> String {
    let mut is_its = false;
    let mut lines = String::new();
    for line in text.lines() {
        is_its = line != "[[figure]]" && (is_its || line.contains(&format!("\"{file}\"")));
        if is_its && line.starts_with("commit =") {
            lines += &format!("commit = \"{commit}\"\n");
        } else if !(is_its && line.starts_with("older =")) {
            lines += &format!("{line}\n");
        }
    }
    lines
}

/// Makes pictures again: all that have a way to, or those whose files have `name` in them. Nothing
/// else may be uncommitted, so that the list can name the commit.
pub fn remake(root: &Path, name: &str) -> Result<()> {
    let figures = read(root)?;
    let has_it = |figure: &&Figure| figure.files.iter().any(|file| file.contains(name));
    let commit = git(root, &["rev-parse", "--short=7", "HEAD"])?;
    for figure in figures.iter().filter(has_it) {
        let (Some(remake), Some(first)) = (&figure.remake, figure.files.first()) else {
            continue;
        };
        let pictures = figure.files.iter().map(|file| format!(":!{file}"));
        let pictures: Vec<String> = pictures.chain([format!(":!{LIST}")]).collect();
        let mut status = vec!["status", "--porcelain", "--", "."];
        status.extend(pictures.iter().map(String::as_str));
        ensure!(
            git(root, &status)?.is_empty(),
            "something is not committed: nobody could make {first} again"
        );
        eprintln!("make: {}", figure.files.join(", "));
        let done = std::process::Command::new("bash")
            .args(["-euo", "pipefail", "-c", remake])
            .current_dir(root)
            .status()
            .context("starting bash")?;
        ensure!(done.success(), "{first}: `{}` failed, {done}", remake.trim());
        are_made_anew(root, first, &commit)?;
    }
    Ok(())
}

/// The table of all figures for a page in `docs/results`.
pub fn table(figures: &[Figure]) -> String {
    let mut table = "\n| figures | made by | of commit | since then |\n|---|---|---|---|\n".to_owned();
    for figure in figures {
        let links = figure.files.iter().map(|file| {
            let beside = file.strip_prefix("docs/results/").map(str::to_owned);
            let in_docs = file.strip_prefix("docs/").map(|file| format!("../{file}"));
            let file = beside.or(in_docs).unwrap_or_else(|| format!("../../{file}"));
            let name = file.rsplit('/').next().unwrap_or_default();
            format!("[{name}]({file})")
        });
        let since = figure.older.as_deref();
        table += &format!(
            "| {} | `{}` | {} | {} |\n",
            links.collect::<Vec<_>>().join(", "),
            figure.command,
            figure.commit,
            since.map_or("unchanged".to_owned(), |why| format!("older: {why}"))
        );
    }
    table + "\n"
}

impl Figure {
    /// Files that make it and have changed since its commit, but for comments and tests.
    fn changed(&self, root: &Path, graph: &Graph) -> Result<Vec<String>> {
        let mut inputs = self.paths.clone();
        for package in &self.packages {
            let reached = graph.ways_from(package, |_| false)?;
            let all = reached.keys().chain([package]);
            inputs.extend(all.filter_map(|name| Some(graph.packages.get(name)?.folder.clone())));
        }
        ensure!(!inputs.is_empty(), "names nothing that makes it");
        for path in &self.paths {
            ensure!(root.join(path).exists(), "`{path}` does not exist");
        }
        inputs.sort();
        inputs.dedup();
        change::since(root, &self.commit, &inputs, &self.paths)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_that_is_made_anew_is_no_longer_older() {
        let figure = |file: &str, commit: &str, older: &str| {
            format!("[[figure]]\nfiles = [\"{file}\"]\ncommand = \"c\"\ncommit = \"{commit}\"\n{older}\n")
        };
        let older = "older = \"slow\"\n";
        let before = figure("a.json", "1", older) + &figure("b.json", "1", older);
        let after = figure("a.json", "1", older) + &figure("b.json", "2", "");
        assert_eq!(noted(&before, "b.json", "2"), after);
    }

    /// A checkout with one package, and a figure that one of its files makes.
    #[test]
    fn a_figure_is_older_than_the_code_that_makes_it_or_says_why() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let write = |file: &str, text: &str| {
            let path = root.join(file);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        let commit = || {
            git(root, &["add", "--all"]).unwrap();
            let own = ["-c", "user.name=n", "-c", "user.email=e"];
            git(root, &[&own[..], &["commit", "--quiet", "-m", "text"]].concat()).unwrap();
            git(root, &["rev-parse", "--short", "HEAD"]).unwrap()
        };
        write(
            "Cargo.toml",
            "[package]\nname = \"made\"\nversion = \"0.1.0\"\nedition = \"2024\"\n",
        );
        write("src/lib.rs", "pub const SIZE_MM: f64 = 1.0;\n");
        git(root, &["init", "--quiet"]).unwrap();
        let made_at = commit();
        let check = |older: Option<&str>| {
            let figure = Figure {
                files: vec!["docs/results/a.json".into()],
                command: "made".into(),
                commit: made_at.clone(),
                packages: Vec::new(),
                paths: vec!["src".into()],
                older: older.map(str::to_owned),
                remake: None,
            };
            check(root, &[figure]).map_err(|error| error.to_string())
        };
        write("src/lib.rs", "// a comment\npub const SIZE_MM: f64 = 1.0;\n");
        commit();
        assert_eq!(check(None), Ok(()));
        assert!(check(Some("slow")).unwrap_err().contains("is as it was"));
        write("src/lib.rs", "pub const SIZE_MM: f64 = 2.0;\n");
        commit();
        assert!(check(None).unwrap_err().contains("src/lib.rs"));
        assert_eq!(check(Some("slow")), Ok(()));
    }
}
