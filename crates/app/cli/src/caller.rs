//! This program, as runs know it.

use std::sync::Arc;

use anyhow::{Context, Result};
use twintac_run::{Caller, sha256_of_file};

use crate::progress::Bars;

/// This program, for runs: its own file is what tells one build from another.
pub(crate) fn caller() -> Result<Caller> {
    let program = std::env::current_exe().context("finding this program's own file")?;
    Ok(Caller {
        program: sha256_of_file(&program)?,
        command: std::env::args().collect::<Vec<_>>().join(" "),
        progress: Arc::new(Bars::default()),
    })
}
