//! The parts of ARCHITECTURE.md that are written from `xtask/rooms.toml`.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};

use super::{Graph, Rooms, Term};

/// Each part's name; it stands between `<!-- rooms: NAME -->` and `<!-- end -->`.
const PARTS: [(&str, fn(&Rooms, &Graph) -> String); 4] = [
    ("table", |rooms, _| table(rooms)),
    ("terms", |rooms, _| terms(rooms)),
    ("arrows", arrows),
    ("invariants", |rooms, _| invariants(rooms)),
];

/// Writes the parts of ARCHITECTURE.md anew.
pub fn write(root: &Path) -> Result<()> {
    let path = root.join("ARCHITECTURE.md");
    let text = fs::read_to_string(&path).with_context(|| format!("reading {}", path.display()))?;
    fs::write(&path, fresh(&text, &Rooms::read(root)?, &Graph::read(root)?)?)?;
    Ok(())
}

/// ARCHITECTURE.md is as [`write`] would leave it.
pub fn is_fresh(root: &Path, rooms: &Rooms, graph: &Graph) -> Result<()> {
    let text = fs::read_to_string(root.join("ARCHITECTURE.md")).context("reading ARCHITECTURE.md")?;
    ensure!(
        fresh(&text, rooms, graph)? == text,
        "ARCHITECTURE.md is not what xtask/rooms.toml says: run `cargo xtask rooms`"
    );
    Ok(())
}

fn fresh(text: &str, rooms: &Rooms, graph: &Graph) -> Result<String> {
    let mut text = text.to_owned();
    for (name, part) in PARTS {
        let begin = format!("<!-- rooms: {name} -->\n");
        let from = text
            .find(&begin)
            .with_context(|| format!("ARCHITECTURE.md has no line `{}`", begin.trim()))?
            + begin.len();
        let length = text[from..]
            .find("<!-- end -->")
            .with_context(|| format!("ARCHITECTURE.md: the part `{name}` has no end"))?;
        text.replace_range(from..from + length, &part(rooms, graph));
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
            room.never.join(", ")
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

fn arrows(rooms: &Rooms, graph: &Graph) -> String {
    let width = rooms
        .rooms
        .iter()
        .map(|room| room.name().len())
        .max()
        .unwrap_or_default();
    let mut text = "\n```\n".to_owned();
    for shelf in &rooms.shelves {
        text += &format!("{shelf}\n");
        for room in rooms.rooms.iter().filter(|room| room.shelf() == Some(shelf)) {
            let known = graph
                .packages
                .get(&room.package())
                .map(|package| &package.dependencies);
            let others = rooms
                .rooms
                .iter()
                .filter(|other| known.is_some_and(|known| known.contains(&other.package())));
            let names: Vec<&str> = others.map(|other| other.name()).collect();
            let line = format!("  {:width$} ─► {}", room.name(), names.join(", "));
            text += line.trim_end_matches([' ', '─', '►']);
            text.push('\n');
        }
    }
    text + "```\n\n"
}

fn invariants(rooms: &Rooms) -> String {
    let paragraphs = rooms
        .invariants
        .iter()
        .map(|invariant| format!("\n**Invariant: {}.** {}\n", invariant.name, invariant.why));
    format!("{}\n", paragraphs.collect::<String>())
}
