//! Makes the hardware of sensors from their descriptions: board, fabrication files, parts list,
//! mechanics.

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
