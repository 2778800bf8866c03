//! A board as the files of a KiCad 9 project.
//!
//! The files have the form that `kicad-cli` 9.0.8 reads without warnings. Identifiers are hashes of
//! names.

mod body;
mod footprint;
mod pcb;
mod schematic;
mod settings;
mod symbol;
mod text;

use std::collections::BTreeMap;

use crate::design::Design;
use text::LIBRARY;

/// The files by their paths in the project's folder.
pub(crate) fn project(board: &Design) -> BTreeMap<String, String> {
    let name = &board.variant;
    let mut files = BTreeMap::new();
    files.insert(format!("{name}.kicad_pro"), settings::project(name));
    files.insert(format!("{name}.kicad_sch"), schematic::schematic(board));
    files.insert(format!("{name}.kicad_pcb"), pcb::pcb(board));
    files.insert(format!("{LIBRARY}.kicad_sym"), symbol::library(board));
    files.insert(
        "sym-lib-table".into(),
        settings::table("sym_lib_table", &format!("{LIBRARY}.kicad_sym")),
    );
    files.insert(
        "fp-lib-table".into(),
        settings::table("fp_lib_table", &format!("{LIBRARY}.pretty")),
    );
    for (land, text) in footprint::library(board) {
        files.insert(format!("{LIBRARY}.pretty/{land}.kicad_mod"), text);
    }
    for (file, text) in body::models(board) {
        files.insert(format!("models/{file}"), text);
    }
    files
}
