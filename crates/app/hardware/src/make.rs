//! Makes one variant after the other: files, checks, fabrication files, mechanics, archive.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use twintac_board::Board;
use twintac_store::{write_file, write_json};

use crate::kicad::Kicad;
use crate::options::Options;
use crate::variant::{Variant, wanted};
use crate::{export, findings, mechanics, netlist, parts, release};

/// Makes all variants that the options name.
pub(crate) fn all(options: &Options) -> Result<()> {
    let parts = parts::read(&options.root.join("hardware/parts.toml"))?;
    let kicad = Kicad::find()?;
    if kicad.is_none() {
        eprintln!(
            "skipped: checks, fabrication files and pictures (there is no `kicad-cli` 9; hardware/check.sh \
            installs it)"
        );
    }
    for variant in wanted(options)? {
        let folder = options.out.join(&variant.name);
        one(options, &variant, &folder, &parts, kicad.as_ref())
            .with_context(|| format!("variant {}", variant.name))?;
    }
    Ok(())
}

fn one(
    options: &Options,
    variant: &Variant,
    folder: &Path,
    known: &parts::Known,
    kicad: Option<&Kicad>,
) -> Result<()> {
    let board = Board::design(&variant.name, &variant.sensor, &variant.chip)?;
    // Existing files may be of another board.
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("removing what {} had", folder.display()))?;
    }
    let archive = release::path(folder, variant);
    if archive.exists() {
        fs::remove_file(&archive).with_context(|| format!("removing {}", archive.display()))?;
    }
    let project = folder.join("board");
    for (file, text) in board.files() {
        write_file(&project.join(file), text.as_bytes())?;
    }
    let geometry = folder.join("geometry.json");
    write_json(&geometry, &board.geometry(&variant.sha256))?;
    write_file(&folder.join("parts.csv"), &parts::csv(&board, known)?)?;
    eprintln!("{}: board project, geometry.json, parts.csv", folder.display());
    if !board.is_footprint_confirmed() {
        eprintln!(
            "  the land pattern of {} is to be confirmed: do not order this board",
            variant.chip
        );
    }
    if let Some(kicad) = kicad {
        let found = findings::of(kicad, &project, &variant.name)?;
        ensure!(found.is_empty(), "KiCad finds:\n  {}", found.join("\n  "));
        eprintln!("  electrical rules, design rules and parity with the schematic: nothing found");
        netlist::compare(kicad, &project, &variant.name, &board.wiring())?;
        eprintln!(
            "  netlist: each of {} taxels is on its channel",
            variant.sensor.taxels.len()
        );
        export::all(kicad, folder, &variant.name)?;
        eprintln!("  Gerber, drill, placement, STEP and pictures");
    }
    mechanics::make(&options.root, &geometry, &folder.join("mechanics"))?;
    if options.release {
        release::write(&archive, folder, variant, board.is_footprint_confirmed())?;
        eprintln!("  {}", archive.display());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mechanics are tested with the geometries of the shipped variants.
    #[test]
    fn the_mechanics_are_tested_with_these_boards() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
        for variant in crate::variant::shipped(&root).unwrap() {
            let board = Board::design(&variant.name, &variant.sensor, &variant.chip).unwrap();
            let made = serde_json::to_value(board.geometry(&variant.sha256)).unwrap();
            let path = root.join(format!("hardware/mechanics/tests/{}.geometry.json", variant.name));
            let kept: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
            assert!(
                kept == made,
                "{} is older: run `cargo xtask hardware`, and copy target/hardware/{}/geometry.json there",
                path.display(),
                variant.name
            );
        }
    }
}
