//! The command line as a library: for the program `twintac`, and for the Python package, whose command it is too.
//!
//! Exit codes: 0 when all was done, 2 when something was wrong with what was asked for or given; the error says what, where, and what to do.
//! 3 when a bench was stopped: what was recorded until then is kept.

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
    /// Does what the arguments ask for. Returns the exit code.
    #[must_use]
    pub fn run(&self) -> u8 {
        let arguments = match Arguments::try_parse_from(&self.arguments) {
            Ok(arguments) => arguments,
            Err(asked) => {
                let _ = asked.print(); // of help and version as well
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

/// An error and what caused it. Some errors quote their cause and name it as well: it is said once.
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
