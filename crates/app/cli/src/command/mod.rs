//! What each command does.

mod calibrate;
mod characterize;
mod demo;
mod export;
mod files;
mod follow;
mod mesh;
mod record;
mod reproduce;
mod sensor;
mod simulate;
mod stages;
mod stream;

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result};
use twintac_run::{Caller, SensorFile, sha256_of_file};

use crate::arguments::{Command, SensorCommand};
use crate::progress::Bars;

pub(crate) use record::Stopped;

/// Does what was asked for.
pub(crate) fn run(command: Command) -> Result<()> {
    match command {
        Command::Demo(arguments) => demo::run(&arguments),
        Command::Reproduce(arguments) => reproduce::run(&arguments),
        Command::Sensor(SensorCommand::Show(arguments)) => sensor::show(&arguments),
        Command::Mesh(arguments) => mesh::run(&arguments),
        Command::Simulate(arguments) => simulate::run(&arguments),
        Command::Calibrate(arguments) => calibrate::run(&arguments),
        Command::Characterize(arguments) => characterize::run(&arguments),
        Command::Stream(arguments) => stream::run(&arguments),
        Command::Record(arguments) => record::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Import(arguments) => reproduce::import(&arguments),
        Command::Align(arguments) => stages::align(&arguments),
        Command::Train(arguments) => stages::train(&arguments),
        Command::Evaluate(arguments) => stages::evaluate(&arguments),
        Command::Report(arguments) => stages::report(&arguments),
    }
}

/// Prints a line of data to standard output; a closed pipe is no error.
pub(crate) fn print(text: &str) -> Result<()> {
    use std::io::{ErrorKind, Write};
    match writeln!(std::io::stdout(), "{text}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

/// Reads a sensor description, or without a file that of PhysTac.
pub(crate) fn sensor_or_phystac(file: Option<&Path>) -> Result<SensorFile> {
    Ok(file.map_or_else(SensorFile::phystac, SensorFile::read)?)
}

/// This program, for runs: its own file is what tells one build from another.
pub(crate) fn caller() -> Result<Caller> {
    let program = std::env::current_exe().context("finding this program's own file")?;
    Ok(Caller {
        program: sha256_of_file(&program)?,
        command: std::env::args().collect::<Vec<_>>().join(" "),
        progress: Arc::new(Bars::default()),
    })
}
