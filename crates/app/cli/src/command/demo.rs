//! `twintac demo`: every stage on the emulated bench.

use anyhow::Result;
use twintac_run::Run;

use crate::Program;
use crate::arguments::Demo;

/// Runs every stage on the emulated bench.
pub(crate) fn run(arguments: &Demo, program: &Program) -> Result<()> {
    let run = Run::demo(&arguments.out, arguments.seed, program.caller()?)?;
    super::stages::finish(&run)
}
