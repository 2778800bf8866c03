//! The parts of ARCHITECTURE.md and docs/reference/crates.md that are written from
//! `xtask/crates.toml` and the code.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};

use super::{Entry, Layers, Term};
use crate::documents::{item, read, replace_part};
use crate::kept;

const ARCHITECTURE: &str = "ARCHITECTURE.md";
const REFERENCE: &str = "docs/reference/crates.md";

/// Writes the parts of both pages anew.
pub fn write(root: &Path) -> Result<()> {
    for (page, text) in fresh(root, &Layers::read(root)?)? {
        fs::write(root.join(page), text).with_context(|| format!("writing {page}"))?;
    }
    Ok(())
}

/// Both pages are as [`write`] would leave them.
pub fn is_fresh(root: &Path, layers: &Layers) -> Result<()> {
    for (page, text) in fresh(root, layers)? {
        ensure!(
            read(root, page)? == text,
            "{page} is not what xtask/crates.toml and the code say: run `cargo xtask crates`"
        );
    }
    Ok(())
}

/// Each page with its parts, which stand between `<!-- crates: NAME -->` and `<!-- end -->`.
fn fresh(root: &Path, layers: &Layers) -> Result<[(&'static str, String); 2]> {
    let parts = [
        (ARCHITECTURE, "crates: owned", owned(layers)),
        (ARCHITECTURE, "crates: invariants", invariants(layers)),
        (REFERENCE, "crates: dependencies", dependencies(layers)),
        (REFERENCE, "crates: terms", terms(layers)),
        (REFERENCE, "crates: kept", kept::table(root)?),
    ];
    let mut pages = [
        (ARCHITECTURE, read(root, ARCHITECTURE)?),
        (REFERENCE, read(root, REFERENCE)?),
    ];
    for (page, text) in &mut pages {
        for (_, name, part) in parts.iter().filter(|(of, ..)| of == page) {
            replace_part(text, name, part).context(*page)?;
        }
    }
    Ok(pages)
}

/// A table of what each crate owns, for each layer, highest first; then for the packages beside
/// them.
fn owned(layers: &Layers) -> String {
    let rows = |is_in: &dyn Fn(&Entry) -> bool| -> String {
        let entries = layers.crates.iter().filter(|entry| is_in(entry));
        let rows = entries.map(|entry| {
            let name = entry.folder.strip_prefix("crates/").unwrap_or(&entry.folder);
            format!("| `{name}` | {} |\n", entry.owns)
        });
        format!("|---|---|\n{}", rows.collect::<String>())
    };
    let mut text = String::new();
    for layer in layers.layers.iter().rev() {
        text += &format!(
            "\n| `crates/{layer}` | |\n{}",
            rows(&|entry| entry.layer() == Some(layer))
        );
    }
    format!(
        "{text}\n| beside | |\n{}\n",
        rows(&|entry| entry.layer().is_none())
    )
}

fn dependencies(layers: &Layers) -> String {
    let mut text = "\n| folder | must not depend on |\n|---|---|\n".to_owned();
    for entry in &layers.crates {
        let never = layers.never(entry);
        if !never.is_empty() {
            text += &format!("| `{}` | {} |\n", entry.folder, never.join(", "));
        }
    }
    text + "\n"
}

fn terms(layers: &Layers) -> String {
    let lines = layers
        .terms
        .iter()
        .map(|(word, term)| item(&format!("{word}: {}", meaning(term))));
    format!("\n{}\n", lines.collect::<String>())
}

fn meaning(term: &Term) -> String {
    let quoted = |names: &[String]| {
        let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        quoted.join(", ")
    };
    let mut parts = Vec::new();
    if term.every_crate {
        parts.push("every other crate of this table".to_owned());
    }
    if !term.crates.is_empty() {
        parts.push(term.crates.join(", "));
    }
    if !term.libraries.is_empty() {
        parts.push(format!("the libraries {}", quoted(&term.libraries)));
    }
    if !term.source.is_empty() {
        parts.push(format!("{} in its sources", quoted(&term.source)));
    }
    if term.directly {
        parts.push("as its own dependency".to_owned());
    }
    parts.join("; ")
}

fn invariants(layers: &Layers) -> String {
    let lines = layers
        .invariants
        .iter()
        .map(|invariant| item(&format!("**{}.** {}", invariant.name, invariant.why)));
    format!("\n{}\n", lines.collect::<String>())
}
