//! The program `twintac`. The library of this package has the command line.

use std::process::ExitCode;

use anyhow::{Context, Result};
use twintac_cli::Program;

fn main() -> Result<ExitCode> {
    let program = Program {
        file: std::env::current_exe().context("finding this program's own file")?,
        arguments: std::env::args_os().collect(),
    };
    Ok(program.run().into())
}
