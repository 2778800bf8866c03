//! This project's solver on the same press, as a row like the others.

use std::io::Write;
use std::time::Instant;

use anyhow::{Context, Result};

use super::row::Figures;
use crate::{bench, cases, files};

/// Clock ticks per second in `/proc`: fixed on Linux, whatever the kernel's own rate (proc(5)).
const TICKS_PER_S: f64 = 100.0;

/// Presses the block, and prints the result as one JSON line.
pub(crate) fn print_row(poissons_ratio: f64) -> Result<()> {
    let started = Instant::now();
    let case = cases::block(poissons_ratio)?;
    let mut first = None;
    let mut last_s = 0.0;
    let followed = case.follow(bench::FAST, &mut || {
        last_s = processor_s().unwrap_or(f64::NAN);
        first.get_or_insert((started.elapsed().as_secs_f64(), last_s));
    })?;
    let (start_up_s, first_s) = first.context("no frame was solved")?;
    // The frame at first contact, without depth, counts as start-up, as for the other engines.
    let frames = &followed.frames;
    let (rest, end) = (
        frames.first().context("no frames")?,
        frames.last().context("no frames")?,
    );
    let wall_s: f64 = frames[1..].iter().map(|frame| frame.wall_time_s).sum();
    let simulated_s = end.time_s - rest.time_s;
    let figures = Figures {
        nodes: followed.n_nodes,
        tets: followed.n_tets,
        rtf: simulated_s / wall_s,
        cpu_s: (last_s - first_s) / simulated_s,
        start_up_s,
        reached_mm: rest.position_mm.z - end.position_mm.z,
        force_n: bench::forces(&followed),
        memory_mib: files::peak_memory_mib()?,
    };
    writeln!(std::io::stdout().lock(), "{}", serde_json::to_string(&figures)?)?;
    Ok(())
}

/// Processor time of this process, s.
fn processor_s() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    // Fields are counted after the name, which may contain spaces: utime and stime are fields 14
    // and 15 (proc(5)).
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks: f64 = fields.get(11)?.parse::<f64>().ok()? + fields.get(12)?.parse::<f64>().ok()?;
    Some(ticks / TICKS_PER_S)
}
