//! Rules of `xtask/rooms.toml`, each checked on its own.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};

use super::{Graph, Package, Room, Rooms};
use crate::code::Crate;

/// Every package of the workspace has a room, every room of the workspace is a package, and names are those of folders.
pub fn every_package_has_a_room(rooms: &Rooms, graph: &Graph) -> Result<()> {
    for (name, package) in &graph.packages {
        let room = rooms.rooms.iter().find(|room| room.folder == package.folder);
        let room = room.with_context(|| format!("`{}` is not in xtask/rooms.toml", package.folder))?;
        ensure!(
            room.package() == *name,
            "the package in `{}` is named `{name}`, not `{}`",
            package.folder,
            room.package()
        );
    }
    for room in &rooms.rooms {
        let is_there = graph
            .packages
            .values()
            .any(|package| package.folder == room.folder);
        ensure!(
            is_there || room.is_beside_the_workspace(),
            "`{}` of xtask/rooms.toml is not in the workspace",
            room.folder
        );
    }
    Ok(())
}

/// No dependency of `room` stands on a higher shelf than `room`, those of its tests included: else neither could be published first.
pub fn arrows_point_down(rooms: &Rooms, graph: &Graph, room: &Room) -> Result<()> {
    let height = |shelf: Option<&str>| {
        rooms
            .shelves
            .iter()
            .position(|known| Some(known.as_str()) == shelf)
    };
    let package = graph.package(&room.package())?;
    for name in package.dependencies.union(&package.dev_dependencies) {
        let other = rooms.rooms.iter().find(|other| other.package() == *name);
        if let Some(other) = other {
            ensure!(
                height(other.shelf()) <= height(room.shelf()),
                "`{}` depends on `{}`, which stands on a higher shelf",
                room.folder,
                other.folder
            );
        }
    }
    Ok(())
}

/// `room` does not know what `word` means. What it reaches through a room that must not know it either is that room's failure.
pub fn never_knows(rooms: &Rooms, graph: &Graph, sources: &[Crate], room: &Room, word: &str) -> Result<()> {
    let term = rooms
        .terms
        .get(word)
        .with_context(|| format!("the term `{word}`"))?;
    let forbidden = |package: &str| {
        let is_library = term.libraries.iter().any(|library| library == package);
        let other = rooms.rooms.iter().find(|other| other.package() == package);
        let is_room =
            other.is_some_and(|other| term.every_room || term.rooms.iter().any(|name| name == other.name()));
        is_library || is_room
    };
    let has_a_test_of_its_own = |package: &str| {
        let other = rooms.rooms.iter().find(|other| other.package() == package);
        other.is_some_and(|other| rooms.never(other).contains(&word))
    };
    let ways = graph.ways_from(&room.package(), has_a_test_of_its_own)?;
    let ways = ways.values().filter(|way| !term.directly || way.len() == 2);
    for way in ways {
        if way.last().is_some_and(|name| forbidden(name)) {
            bail!(
                "`{}` must never know {word}, but {}",
                room.folder,
                way.join(" → ")
            );
        }
    }
    for file in sources
        .iter()
        .filter(|sources| sources.package == room.package())
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
                    room.folder,
                    file.path,
                    mention.line
                );
            }
        }
    }
    Ok(())
}

/// A package says what it is in its `Cargo.toml`, and each of its libraries and programs in the first lines of its root file.
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
        let begins = ["//! ", "#![doc = include_str!("]
            .iter()
            .any(|begin| text.starts_with(begin));
        ensure!(begins, "{place} does not begin with `//!` and what it is");
    }
    Ok(())
}
