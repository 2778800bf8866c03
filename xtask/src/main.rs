//! House rules and checks: `cargo xtask ci` runs what CI runs.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

#[cfg(test)]
mod tidy;

use std::process::{Command, ExitCode};

use anyhow::{Context, Result, bail};

const USAGE: &str = "usage: cargo xtask <ci | lint | test | bench softbody [--json]>
  ci     lint, then test: what CI runs
  lint   formatting and clippy, warnings are errors
  test   every test, optimised
  bench  how fast presses are followed, and how far off tight solutions they are";

fn main() -> ExitCode {
    let task = std::env::args().nth(1).unwrap_or_default();
    let result = match task.as_str() {
        "ci" => lint().and_then(|()| test()),
        "lint" => lint(),
        "test" => test(),
        "bench" => bench(),
        _ => Err(anyhow::anyhow!("there is no task `{task}`\n{USAGE}")),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

fn lint() -> Result<()> {
    cargo(&["fmt", "--all", "--check"])?;
    cargo(&[
        "clippy",
        "--release",
        "--workspace",
        "--all-targets",
        "--",
        "--deny",
        "warnings",
    ])
}

fn test() -> Result<()> {
    cargo(&["test", "--release", "--workspace"])
}

fn bench() -> Result<()> {
    let given: Vec<String> = std::env::args().skip(2).collect();
    let mut arguments = vec!["run", "--release", "--quiet", "--package", "twintac-verify", "--"];
    arguments.extend(given.iter().map(String::as_str));
    cargo(&arguments)
}

fn cargo(arguments: &[&str]) -> Result<()> {
    eprintln!("cargo {}", arguments.join(" "));
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(arguments)
        .status()
        .context("starting cargo")?;
    if !status.success() {
        bail!("`cargo {}` failed", arguments.join(" "));
    }
    Ok(())
}
