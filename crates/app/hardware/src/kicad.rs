//! KiCad's command line.

use std::path::Path;
use std::process::{Command, Output};

use anyhow::{Context, Result, bail};

/// `kicad-cli`, version 9.
pub(crate) struct Kicad;

const PROGRAM: &str = "kicad-cli";

impl Kicad {
    /// Finds KiCad. `None` if it is not installed or has another version.
    pub(crate) fn find() -> Result<Option<Self>> {
        let Ok(output) = Command::new(PROGRAM).arg("--version").output() else {
            return Ok(None);
        };
        let version = String::from_utf8_lossy(&output.stdout);
        Ok((output.status.success() && version.trim().starts_with("9.")).then_some(Self))
    }

    /// Runs it in a folder, whatever its exit code.
    pub(crate) fn output(&self, folder: &Path, arguments: &[&str]) -> Result<Output> {
        Command::new(PROGRAM)
            .args(arguments)
            .current_dir(folder)
            .output()
            .with_context(|| format!("starting {PROGRAM}"))
    }

    /// Runs it in a folder; an exit code other than 0 is an error.
    pub(crate) fn run(&self, folder: &Path, arguments: &[&str]) -> Result<()> {
        let output = self.output(folder, arguments)?;
        if !output.status.success() {
            bail!(
                "`{PROGRAM} {}` failed: {}{}",
                arguments.join(" "),
                String::from_utf8_lossy(&output.stdout),
                String::from_utf8_lossy(&output.stderr)
            );
        }
        Ok(())
    }
}
