//! Git, as a program.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, bail};

/// What `git` prints in a folder, without white space around it.
pub(crate) fn git(root: &Path, arguments: &[&str]) -> Result<String> {
    let output = Command::new("git")
        .args(arguments)
        .current_dir(root)
        .output()
        .context("starting git")?;
    if !output.status.success() {
        bail!(
            "`git {}`: {}",
            arguments.join(" "),
            String::from_utf8_lossy(&output.stderr).trim()
        );
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
