//! `twintac demo`: the emulated bench, from nothing.

use anyhow::Result;
use twintac_run::Run;

use crate::arguments::Demo;
use crate::caller::caller;

/// Runs every stage on the emulated bench.
pub(crate) fn run(arguments: &Demo) -> Result<()> {
    let run = Run::demo(&arguments.out, arguments.seed, caller()?)?;
    super::stages::finish(&run)
}
