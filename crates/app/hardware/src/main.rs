//! Makes the hardware of sensors from their descriptions: board project, checks, fabrication files,
//! parts list, mechanics.
//!
//! Input: a sensor's description (TOML) and the kind of its barometers; without a description, the
//! three shipped variants. Output: one folder for each variant.
//!
//! # How it works
//!
//! For each variant, in order:
//!
//! ```text
//! board/          KiCad project: schematic, board with routed tracks (made by
//!                 `crates/sensor/board`)
//! geometry.json   measures of gel, ports and board, in mm: the input of the mechanics
//! parts.csv       parts list with known prices (from `hardware/parts.toml`)
//! checks/         reports of KiCad's electrical and design rules
//! fabrication/    Gerber, drill and placement files
//! <name>.step, schematic.pdf, pictures/
//! mechanics/      parts to print, checks and casting sheet, by Python programs in
//!                 `hardware/mechanics`
//! <variant>.zip   with `--release`: all but checks and pictures, with a SHA-256 of each file
//! ```
//!
//! Checks and fabrication files need `kicad-cli` 9, mechanics a Python interpreter that
//! `TWINTAC_HARDWARE_PYTHON` names; without these the steps are skipped with a message. The netlist
//! is also compared with the description: each taxel has to be on its channel. Every violation that
//! a check reports is an error. Dates in files are replaced by a fixed one, so the same description
//! gives the same bytes.
//!
//! The program depends on no solver, device, recording or learning. `cargo xtask hardware` runs it.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

use std::process::ExitCode;

use clap::Parser as _;

mod archive;
mod dates;
mod export;
mod findings;
mod kicad;
mod make;
mod mechanics;
mod netlist;
mod options;
mod parts;
mod release;
mod variant;

fn main() -> ExitCode {
    match make::all(&options::Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}
