//! The parts of ARCHITECTURE.md that are written from `xtask/rooms.toml` and the code.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};

use super::{Rooms, Term};
use crate::documents::replace_part;
use crate::kept;

/// A part's name, and what it says.
type Part = (&'static str, fn(&Rooms) -> String);

/// Each part stands between `<!-- rooms: NAME -->` and `<!-- end -->`.
const PARTS: [Part; 3] = [("table", table), ("terms", terms), ("invariants", invariants)];

/// Writes the parts of ARCHITECTURE.md anew.
pub fn write(root: &Path) -> Result<()> {
    let path = root.join("ARCHITECTURE.md");
    let text = fs::read_to_string(&path).with_context(|| format!("reading {}", path.display()))?;
    fs::write(&path, fresh(root, &text, &Rooms::read(root)?)?)?;
    Ok(())
}

/// ARCHITECTURE.md is as [`write`] would leave it.
pub fn is_fresh(root: &Path, rooms: &Rooms) -> Result<()> {
    let text = fs::read_to_string(root.join("ARCHITECTURE.md")).context("reading ARCHITECTURE.md")?;
    ensure!(
        fresh(root, &text, rooms)? == text,
        "ARCHITECTURE.md is not what xtask/rooms.toml and the code say: run `cargo xtask rooms`"
    );
    Ok(())
}

fn fresh(root: &Path, text: &str, rooms: &Rooms) -> Result<String> {
    let mut text = text.to_owned();
    replace_part(&mut text, "kept", &kept::table(root)?).context("ARCHITECTURE.md")?;
    for (name, part) in PARTS {
        replace_part(&mut text, &format!("rooms: {name}"), &part(rooms)).context("ARCHITECTURE.md")?;
    }
    Ok(text)
}

fn table(rooms: &Rooms) -> String {
    let mut text = "\n| folder | owns | must never know |\n|---|---|---|\n".to_owned();
    for room in &rooms.rooms {
        text += &format!(
            "| `{}` | {} | {} |\n",
            room.folder,
            room.owns,
            rooms.never(room).join(", ")
        );
    }
    text + "\n"
}

fn terms(rooms: &Rooms) -> String {
    let lines = rooms
        .terms
        .iter()
        .map(|(word, term)| format!("- {word}: {}\n", meaning(term)));
    format!("\n{}\n", lines.collect::<String>())
}

fn meaning(term: &Term) -> String {
    let quoted = |names: &[String]| {
        let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        quoted.join(", ")
    };
    let mut parts = Vec::new();
    if term.every_room {
        parts.push("every other crate of this table".to_owned());
    }
    if !term.rooms.is_empty() {
        parts.push(term.rooms.join(", "));
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

fn invariants(rooms: &Rooms) -> String {
    let paragraphs = rooms
        .invariants
        .iter()
        .map(|invariant| format!("\n**Invariant: {}.** {}\n", invariant.name, invariant.why));
    format!("{}\n", paragraphs.collect::<String>())
}
