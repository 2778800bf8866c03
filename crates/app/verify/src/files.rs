//! Writing files as a whole, and the memory of this process.

use std::path::Path;

use anyhow::{Context, Result};

/// Writes under a temporary name first: the file is either complete or absent.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    twintac_store::write_whole(path, bytes).with_context(|| format!("writing {}", path.display()))
}

/// Peak memory of this process, MiB.
pub(crate) fn peak_memory_mib() -> Result<f64> {
    in_status("self", "VmHWM:")
}

/// Memory of a process, MiB.
pub(crate) fn memory_mib(process: u32) -> Result<f64> {
    in_status(&process.to_string(), "VmRSS:")
}

fn in_status(process: &str, name: &str) -> Result<f64> {
    let text = std::fs::read_to_string(format!("/proc/{process}/status"))
        .context("memory is read from Linux's /proc")?;
    let line = text.lines().find_map(|line| line.strip_prefix(name));
    let kib = line
        .and_then(|line| line.split_whitespace().next())
        .context("a line on memory")?;
    Ok(kib.parse::<f64>()? / 1024.0)
}
