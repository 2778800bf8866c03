//! Cargo, called.

use std::process::{Command, ExitStatus};

use anyhow::{Context, Result, bail};

/// Runs Cargo; an exit code other than 0 is an error.
pub fn cargo(arguments: &[&str]) -> Result<()> {
    if !run(arguments)?.success() {
        bail!("`cargo {}` failed", arguments.join(" "));
    }
    Ok(())
}

/// Runs Cargo, and says so.
pub fn run(arguments: &[&str]) -> Result<ExitStatus> {
    eprintln!("cargo {}", arguments.join(" "));
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    Command::new(cargo)
        .args(arguments)
        .status()
        .context("starting cargo")
}
