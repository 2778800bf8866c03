//! One archive for each variant, with all that a board manufacturer and a 3D printer need, and
//! checksums of all files.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use twintac_store::{Digest, write_file};

use crate::archive;
use crate::variant::Variant;

/// Folders that are not in the archive.
const LEFT_OUT: [&str; 2] = ["checks", "pictures"];

/// The path of a variant's archive, beside its folder.
pub(crate) fn path(folder: &Path, variant: &Variant) -> PathBuf {
    folder.with_file_name(format!("{}.zip", variant.name))
}

/// Writes the archive of a folder.
pub(crate) fn write(path: &Path, folder: &Path, variant: &Variant, is_confirmed: bool) -> Result<()> {
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    collect(folder, folder, &mut files)?;
    files.push(("LAYERS.txt".to_owned(), note(variant, is_confirmed).into_bytes()));
    files.sort();
    let mut sums = String::new();
    for (name, bytes) in &files {
        let _ = writeln!(sums, "{}  {name}", Digest::of(bytes));
    }
    files.push(("SHA256SUMS".to_owned(), sums.into_bytes()));
    Ok(write_file(path, &archive::of(&files)?)?)
}

fn collect(root: &Path, folder: &Path, files: &mut Vec<(String, Vec<u8>)>) -> Result<()> {
    for entry in fs::read_dir(folder).with_context(|| format!("reading {}", folder.display()))? {
        let path = entry?.path();
        let name = path.strip_prefix(root)?.to_string_lossy().replace('\\', "/");
        if !path.is_dir() {
            let bytes = fs::read(&path).with_context(|| format!("reading {}", path.display()))?;
            files.push((name, bytes));
        } else if !LEFT_OUT.contains(&name.as_str()) {
            collect(root, &path, files)?;
        }
    }
    Ok(())
}

fn note(variant: &Variant, is_confirmed: bool) -> String {
    use twintac_board::rules;
    let warning = if is_confirmed {
        String::new()
    } else {
        format!(
            "DO NOT ORDER: the land pattern, the pins and the height of {} are to be confirmed.\n\n",
            variant.chip
        )
    };
    format!(
        "TwinTac {name}\n\n{warning}Nobody has built this board yet.\n\n\
         Two layers, FR-4, {thickness} mm, copper of 35 um, any colour of solder mask, silk screen on both faces.\n\
         Tracks and gaps of {track} mm or more, vias of {via} mm with drills of {drill} mm, covered by solder mask.\n\
         Order of layers, from the top: F_Silkscreen, F_Mask, F_Cu, B_Cu, B_Mask, B_Silkscreen. \
         Edge_Cuts is the outline.\n\
         Drill files: -PTH.drl plated, -NPTH.drl not plated (two holes for M2 screws).\n\
         Barometers are on the top face, all other parts on the bottom face. \
         Placement: fabrication/placement.csv, in mm.\n",
        name = variant.name,
        thickness = rules::THICKNESS_MM,
        track = rules::SIGNAL_WIDTH_MM,
        via = rules::VIA_MM,
        drill = rules::VIA_DRILL_MM,
    )
}
