//! The command line `twintac` as a library: for the program, and for the Python package, whose
//! command is the same.
//!
//! [`Program`] takes the arguments and the file of the program; [`Program::run`] runs one command
//! and returns the exit code: 0 if everything was done; 2 if an argument or an input was wrong (the
//! error says what, where, and what to do); 3 if a test setup was stopped (what was recorded until
//! then is kept).
//!
//! # How it works
//!
//! `arguments` declares the commands and options with clap, and checks combinations. `command` has
//! a file for each command; it calls the crates that do the work (`crates/app/run`, `model`, `gel`,
//! `dataset` and others) and prints their results: no figure is computed here. Data go to standard
//! output; messages and progress go to standard error, as a bar on a terminal and as a line a
//! minute elsewhere. Texts from files and devices are printed so that they cannot control the
//! terminal.
//!
//! The help texts are the comments of the arguments. The documentation and snapshot tests
//! (`tests/snapshots`) show them.
//!
//! The crate does not depend directly on the solver, and not on the libraries of file formats:
//! results reach it through the other crates.

mod arguments;
mod command;
mod output;
mod program;
mod progress;

use std::io::Write;

use anyhow::{Context, Result};
use clap::Parser;
use twintac_text::visible;

use crate::arguments::Arguments;
pub use crate::program::Program;

impl Program {
    /// Runs the command of the arguments, and returns the exit code.
    #[must_use]
    pub fn run(&self) -> u8 {
        let arguments = match Arguments::try_parse_from(&self.arguments) {
            Ok(arguments) => arguments,
            Err(asked) => {
                let _ = asked.print(); // also for help and version
                return if asked.use_stderr() { 2 } else { 0 };
            }
        };
        match run(arguments, self) {
            Ok(()) => 0,
            Err(error) => {
                let _ = writeln!(std::io::stderr(), "error: {}", visible(&said(&error)));
                if error.is::<command::Stopped>() { 3 } else { 2 }
            }
        }
    }
}

/// An error and its causes. Some errors quote their cause and also have it as source: it is printed
/// once.
fn said(error: &anyhow::Error) -> String {
    let mut said = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if said.contains(&cause) {
            continue;
        }
        if !said.is_empty() {
            said.push_str(": ");
        }
        said.push_str(&cause);
    }
    said
}

fn run(arguments: Arguments, program: &Program) -> Result<()> {
    if let Some(threads) = arguments.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build_global()
            .context("starting threads")?;
    }
    command::run(arguments.command, program)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cause_is_said_once() {
        #[derive(Debug, thiserror::Error)]
        #[error("cannot read a.toml: {source}")]
        struct Quoting {
            source: std::io::Error,
        }
        let error = anyhow::Error::new(Quoting {
            source: std::io::Error::other("no such file"),
        });
        assert_eq!(
            said(&error.context("reading settings")),
            "reading settings: cannot read a.toml: no such file"
        );
    }
}
