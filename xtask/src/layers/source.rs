//! `xtask/crates.toml`, as it is written.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use serde::Deserialize;

/// The whole of `xtask/crates.toml`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layers {
    /// The folders of `crates`, lowest first.
    pub layers: Vec<String>,
    /// What the words under `never` mean, by word.
    pub terms: BTreeMap<String, Term>,
    /// What holds across crates.
    #[serde(rename = "invariant")]
    pub invariants: Vec<Invariant>,
    /// Every crate, in the order of the tables.
    #[serde(rename = "crate")]
    pub crates: Vec<Entry>,
}

/// A word under `never`, as something that can be checked.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Term {
    /// Crates that must not be reached through dependencies, by the last part of their folder.
    pub crates: Vec<String>,
    /// Every crate but the one that must not know it.
    pub every_crate: bool,
    /// Libraries of others that must not be reached, by package name.
    pub libraries: Vec<String>,
    /// Paths (`std::fs`) and macros (`println`) that must not stand in the crate's own sources,
    /// tests excepted.
    pub source: Vec<String>,
    /// Only the crate's own `Cargo.toml` counts: it may reach these crates through others.
    pub directly: bool,
}

/// A rule of several crates, with a name of its own.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Invariant {
    /// What it is called, as a sentence without its full stop.
    pub name: String,
    /// Why, in a sentence or two.
    pub why: String,
    /// The table has it beside what else each crate must never know.
    #[serde(default = "yes")]
    pub is_in_the_table: bool,
    /// Who must not know what.
    pub bars: Vec<Bar>,
}

/// Crates, and what none of them may know.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bar {
    /// The crates, by the last part of their folder.
    #[serde(default)]
    pub crates: Vec<String>,
    /// Every crate of these layers.
    #[serde(default)]
    pub layers: Vec<String>,
    /// In words of [`Layers::terms`].
    pub never: Vec<String>,
}

/// A crate, or a package beside the workspace.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Its folder, from the root of the checkout.
    pub folder: String,
    /// Its package, where that is not `twintac-` and the last part of the folder (with `-` for
    /// `_`).
    pub package: Option<String>,
    /// What it owns.
    pub owns: String,
    /// What it must never know, in words of [`Layers::terms`].
    #[serde(default)]
    pub never: Vec<String>,
}

impl Bar {
    /// Whether it binds this entry.
    pub fn binds(&self, entry: &Entry) -> bool {
        let is_in_a_layer = entry
            .layer()
            .is_some_and(|layer| self.layers.iter().any(|own| own == layer));
        is_in_a_layer || self.crates.iter().any(|name| name == entry.name())
    }
}

impl Entry {
    /// The last part of its folder.
    pub fn name(&self) -> &str {
        self.folder.rsplit('/').next().unwrap_or_default()
    }

    /// The name of its package.
    pub fn package(&self) -> String {
        self.package
            .clone()
            .unwrap_or_else(|| format!("twintac-{}", self.name().replace('_', "-")))
    }

    /// Whether it is a package with a lock file of its own.
    pub fn is_beside_the_workspace(&self) -> bool {
        ["firmware", "fuzz", "web"].contains(&self.folder.as_str())
    }

    /// The folder of `crates` that it stands in, if it does.
    pub fn layer(&self) -> Option<&str> {
        self.folder.strip_prefix("crates/")?.split('/').next()
    }
}

impl Layers {
    /// Reads `xtask/crates.toml` of the checkout at `root`. Words without a meaning, meanings
    /// without a word, and unknown crates are errors.
    pub fn read(root: &Path) -> Result<Self> {
        let path = root.join("xtask/crates.toml");
        let text = fs::read_to_string(&path).with_context(|| format!("reading {}", path.display()))?;
        let layers: Self = toml::from_str(&text).with_context(|| format!("reading {}", path.display()))?;
        layers.check().context("xtask/crates.toml")?;
        Ok(layers)
    }

    /// The entry of this name.
    pub fn entry(&self, name: &str) -> Result<&Entry> {
        let found = self.crates.iter().find(|entry| entry.name() == name);
        found.with_context(|| format!("there is no crate `{name}`"))
    }

    /// All that a crate must never know, by invariants and of its own, in words of [`Self::terms`].
    pub fn never<'a>(&'a self, entry: &'a Entry) -> Vec<&'a str> {
        let bars = self
            .invariants
            .iter()
            .filter(|invariant| invariant.is_in_the_table);
        let bars = bars
            .flat_map(|invariant| &invariant.bars)
            .filter(|bar| bar.binds(entry));
        let words = bars.flat_map(|bar| &bar.never).chain(&entry.never);
        words.map(String::as_str).collect()
    }

    fn check(&self) -> Result<()> {
        let words = || {
            let of_layers = self.crates.iter().flat_map(|entry| &entry.never);
            let bars = self.invariants.iter().flat_map(|invariant| &invariant.bars);
            of_layers.chain(bars.flat_map(|bar| &bar.never))
        };
        if let Some(word) = words().find(|&word| !self.terms.contains_key(word)) {
            bail!("`{word}` is under `never`, but not in [terms]");
        }
        if let Some(word) = self.terms.keys().find(|&word| !words().any(|used| used == word)) {
            bail!("no crate has the term `{word}` under `never`");
        }
        for (word, term) in &self.terms {
            for name in &term.crates {
                self.entry(name).with_context(|| format!("the term `{word}`"))?;
            }
        }
        for invariant in &self.invariants {
            for name in invariant.bars.iter().flat_map(|bar| &bar.crates) {
                self.entry(name)
                    .with_context(|| format!("the invariant `{}`", invariant.name))?;
            }
        }
        for entry in &self.crates {
            let never = self.never(entry);
            if let Some(word) = entry
                .never
                .iter()
                .find(|&word| never.iter().filter(|other| *other == word).count() > 1)
            {
                bail!(
                    "`{}`: an invariant says already that it never knows {word}",
                    entry.folder
                );
            }
            if let Some(layer) = entry.layer()
                && !self.layers.iter().any(|known| known == layer)
            {
                bail!("`{}` is in no layer", entry.folder);
            }
        }
        Ok(())
    }
}

fn yes() -> bool {
    true
}
