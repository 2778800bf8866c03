//! Files that appear whole, and what the system says of this process.

use std::path::Path;

use anyhow::{Context, Result};

/// Writes under a temporary name first: files are there in full or not at all.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    twintac_store::write_whole(path, bytes).with_context(|| format!("writing {}", path.display()))
}

/// The most memory that this process held, MiB.
pub(crate) fn peak_memory_mib() -> Result<f64> {
    let text =
        std::fs::read_to_string("/proc/self/status").context("peak memory is read from Linux's /proc")?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line
        .and_then(|line| line.split_whitespace().next())
        .context("VmHWM")?;
    Ok(kib.parse::<f64>()? / 1024.0)
}
