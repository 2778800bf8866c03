//! `xtask/rooms.toml`, as it is written.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use serde::Deserialize;

/// The whole of `xtask/rooms.toml`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rooms {
    /// The folders of `crates`, lowest first.
    pub shelves: Vec<String>,
    /// What the words under `never` mean, by word.
    pub terms: BTreeMap<String, Term>,
    /// What holds across rooms.
    #[serde(rename = "invariant")]
    pub invariants: Vec<Invariant>,
    /// Every crate, in the order of the table in ARCHITECTURE.md.
    #[serde(rename = "room")]
    pub rooms: Vec<Room>,
}

/// A word under `never`, as something that can be checked.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Term {
    /// Rooms that must not be reached through dependencies, by the last part of their folder.
    pub rooms: Vec<String>,
    /// Every room but the one that must not know it.
    pub every_room: bool,
    /// Libraries of others that must not be reached, by package name.
    pub libraries: Vec<String>,
    /// Paths (`std::fs`) and macros (`println`) that must not stand in the room's own sources, tests excepted.
    pub source: Vec<String>,
    /// Only the room's own `Cargo.toml` counts: it may reach these rooms through others.
    pub directly: bool,
}

/// A rule of several rooms, with a name of its own.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Invariant {
    /// What it is called, as a sentence without its full stop.
    pub name: String,
    /// Why, in a sentence or two.
    pub why: String,
    /// The table has it beside what else each room must never know.
    #[serde(default = "yes")]
    pub is_in_the_table: bool,
    /// Who must not know what.
    pub bars: Vec<Bar>,
}

/// Rooms, and what none of them may know.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bar {
    /// The rooms, by the last part of their folder.
    #[serde(default)]
    pub rooms: Vec<String>,
    /// Every room of these shelves.
    #[serde(default)]
    pub shelves: Vec<String>,
    /// In words of [`Rooms::terms`].
    pub never: Vec<String>,
}

/// A crate, or a package beside the workspace.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Room {
    /// Its folder, from the root of the checkout.
    pub folder: String,
    /// Its package, where that is not `twintac-` and the last part of the folder (with `-` for `_`).
    pub package: Option<String>,
    /// What it owns.
    pub owns: String,
    /// What it must never know, in words of [`Rooms::terms`].
    #[serde(default)]
    pub never: Vec<String>,
}

impl Bar {
    /// Whether it binds this room.
    pub fn binds(&self, room: &Room) -> bool {
        let is_on_shelf = room
            .shelf()
            .is_some_and(|shelf| self.shelves.iter().any(|own| own == shelf));
        is_on_shelf || self.rooms.iter().any(|name| name == room.name())
    }
}

impl Room {
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
    pub fn shelf(&self) -> Option<&str> {
        self.folder.strip_prefix("crates/")?.split('/').next()
    }
}

impl Rooms {
    /// Reads `xtask/rooms.toml` of the checkout at `root`. Words without a meaning, meanings without a word, and unknown rooms are errors.
    pub fn read(root: &Path) -> Result<Self> {
        let path = root.join("xtask/rooms.toml");
        let text = fs::read_to_string(&path).with_context(|| format!("reading {}", path.display()))?;
        let rooms: Self = toml::from_str(&text).with_context(|| format!("reading {}", path.display()))?;
        rooms.check().context("xtask/rooms.toml")?;
        Ok(rooms)
    }

    /// The room of this name.
    pub fn room(&self, name: &str) -> Result<&Room> {
        let found = self.rooms.iter().find(|room| room.name() == name);
        found.with_context(|| format!("there is no room `{name}`"))
    }

    /// All that a room must never know, by invariants and of its own, in words of [`Self::terms`].
    pub fn never<'a>(&'a self, room: &'a Room) -> Vec<&'a str> {
        let bars = self
            .invariants
            .iter()
            .filter(|invariant| invariant.is_in_the_table);
        let bars = bars
            .flat_map(|invariant| &invariant.bars)
            .filter(|bar| bar.binds(room));
        let words = bars.flat_map(|bar| &bar.never).chain(&room.never);
        words.map(String::as_str).collect()
    }

    fn check(&self) -> Result<()> {
        let words = || {
            let of_rooms = self.rooms.iter().flat_map(|room| &room.never);
            let bars = self.invariants.iter().flat_map(|invariant| &invariant.bars);
            of_rooms.chain(bars.flat_map(|bar| &bar.never))
        };
        if let Some(word) = words().find(|&word| !self.terms.contains_key(word)) {
            bail!("`{word}` is under `never`, but not in [terms]");
        }
        if let Some(word) = self.terms.keys().find(|&word| !words().any(|used| used == word)) {
            bail!("no room has the term `{word}` under `never`");
        }
        for (word, term) in &self.terms {
            for name in &term.rooms {
                self.room(name).with_context(|| format!("the term `{word}`"))?;
            }
        }
        for invariant in &self.invariants {
            for name in invariant.bars.iter().flat_map(|bar| &bar.rooms) {
                self.room(name)
                    .with_context(|| format!("the invariant `{}`", invariant.name))?;
            }
        }
        for room in &self.rooms {
            let never = self.never(room);
            if let Some(word) = room
                .never
                .iter()
                .find(|&word| never.iter().filter(|other| *other == word).count() > 1)
            {
                bail!(
                    "`{}`: an invariant says already that it never knows {word}",
                    room.folder
                );
            }
            if let Some(shelf) = room.shelf()
                && !self.shelves.iter().any(|known| known == shelf)
            {
                bail!("`{}` stands on no shelf", room.folder);
            }
        }
        Ok(())
    }
}

fn yes() -> bool {
    true
}
