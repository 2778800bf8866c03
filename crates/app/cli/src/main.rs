//! TwinTac: barometric touch sensors and their digital twin, from the command line.
//!
//! Exit codes: 0 when all was done, 2 when something was wrong with what was asked for or given; the error says what, where, and what to do.
//! 3 when a bench was stopped: what was recorded until then is kept.

mod arguments;
mod caller;
mod command;
mod output;
mod progress;

use std::io::Write;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::Parser;

use crate::arguments::Arguments;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "error: {error:#}");
            ExitCode::from(if error.is::<command::Stopped>() { 3 } else { 2 })
        }
    }
}

fn run(arguments: Arguments) -> Result<()> {
    if let Some(threads) = arguments.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build_global()
            .context("starting threads")?;
    }
    command::run(arguments.command)
}
