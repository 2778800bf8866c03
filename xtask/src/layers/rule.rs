//! Rules of `xtask/crates.toml`, each checked on its own.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};

use super::{Entry, Graph, Layers, Package};
use crate::code::Crate;

/// A front page of fewer lines does not tell how a crate works.
const LEAST_LINES_OF_A_PAGE: usize = 10;

/// Every package of the workspace has an entry, every entry is a package, and names are those of
/// folders.
pub fn every_package_has_an_entry(crates: &Layers, graph: &Graph) -> Result<()> {
    for (name, package) in &graph.packages {
        let entry = crates.crates.iter().find(|entry| entry.folder == package.folder);
        let entry = entry.with_context(|| format!("`{}` is not in xtask/crates.toml", package.folder))?;
        ensure!(
            entry.package() == *name,
            "the package in `{}` is named `{name}`, not `{}`",
            package.folder,
            entry.package()
        );
    }
    for entry in &crates.crates {
        let is_there = graph
            .packages
            .values()
            .any(|package| package.folder == entry.folder);
        ensure!(
            is_there || entry.is_beside_the_workspace(),
            "`{}` of xtask/crates.toml is not in the workspace",
            entry.folder
        );
    }
    Ok(())
}

/// No dependency of `entry` is in a higher layer than `entry`, those of its tests included: else
/// neither could be published first.
pub fn arrows_point_down(crates: &Layers, graph: &Graph, entry: &Entry) -> Result<()> {
    let height = |layer: Option<&str>| {
        crates
            .layers
            .iter()
            .position(|known| Some(known.as_str()) == layer)
    };
    let package = graph.package(&entry.package())?;
    for name in package.dependencies.union(&package.dev_dependencies) {
        let other = crates.crates.iter().find(|other| other.package() == *name);
        if let Some(other) = other {
            ensure!(
                height(other.layer()) <= height(entry.layer()),
                "`{}` depends on `{}`, which is in a higher layer",
                entry.folder,
                other.folder
            );
        }
    }
    Ok(())
}

/// `entry` does not know what `word` means. What it reaches through a crate that must not know it
/// either is that crate's failure.
pub fn never_knows(
    crates: &Layers,
    graph: &Graph,
    sources: &[Crate],
    entry: &Entry,
    word: &str,
) -> Result<()> {
    let term = crates
        .terms
        .get(word)
        .with_context(|| format!("the term `{word}`"))?;
    let forbidden = |package: &str| {
        let is_library = term.libraries.iter().any(|library| library == package);
        let other = crates.crates.iter().find(|other| other.package() == package);
        let is_crate = other
            .is_some_and(|other| term.every_crate || term.crates.iter().any(|name| name == other.name()));
        is_library || is_crate
    };
    let has_a_test_of_its_own = |package: &str| {
        let other = crates.crates.iter().find(|other| other.package() == package);
        other.is_some_and(|other| crates.never(other).contains(&word))
    };
    let ways = graph.ways_from(&entry.package(), has_a_test_of_its_own)?;
    let ways = ways.values().filter(|way| !term.directly || way.len() == 2);
    for way in ways {
        if way.last().is_some_and(|name| forbidden(name)) {
            bail!(
                "`{}` must never know {word}, but {}",
                entry.folder,
                way.join(" → ")
            );
        }
    }
    for file in sources
        .iter()
        .filter(|sources| sources.package == entry.package())
        .flat_map(|sources| &sources.files)
    {
        for mention in &file.mentions {
            let path = mention.path();
            let found = term
                .source
                .iter()
                .find(|pattern| path == **pattern || path.starts_with(&format!("{pattern}::")));
            if let Some(pattern) = found {
                bail!(
                    "`{}` must never know {word}, but {}:{} has `{pattern}`",
                    entry.folder,
                    file.path,
                    mention.line
                );
            }
        }
    }
    Ok(())
}

/// A package says what it is in its `Cargo.toml`, and each of its libraries and programs in the
/// first lines of its root file.
pub fn has_a_front_page(root: &Path, package: &Package) -> Result<()> {
    let has_description = package
        .description
        .as_ref()
        .is_some_and(|text| !text.trim().is_empty());
    ensure!(
        has_description,
        "{}/Cargo.toml has no description",
        package.folder
    );
    for file in package.lib_file.iter().chain(&package.programs) {
        let text = fs::read_to_string(file)?;
        let place = file.strip_prefix(root).unwrap_or(file).display();
        let is_library = package.lib_file.as_ref() == Some(file);
        let least = if is_library { LEAST_LINES_OF_A_PAGE } else { 1 };
        let lines = text.lines().take_while(|line| line.starts_with("//!")).count();
        let includes_one = text.starts_with("#![doc = include_str!(");
        ensure!(
            includes_one || lines >= least,
            "{place} begins with {lines} lines of `//!`: at least {least} say what it is, what goes in and out, and how it works"
        );
    }
    Ok(())
}
