//! Recording on the emulated bench: its frame rate, the effect of each fault, and the state after a
//! kill. The benchmark runs the command as users do: `cargo xtask bench recording`.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

mod faults;
mod kills;
mod lab_bench;
mod page;
mod results;

use std::path::Path;

use anyhow::{Result, ensure};

use crate::files::write_whole;
use lab_bench::LabBench;
use results::Results;

/// Folder of the results.
const RESULTS: &str = "docs/benchmarks";

#[derive(clap::Args)]
pub(crate) struct Options {
    /// Number of recordings to kill.
    #[arg(long, default_value_t = 50)]
    kills: usize,
    /// Seed of the times at which they are killed.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

pub(crate) fn run(options: &Options) -> Result<()> {
    let bench = LabBench::new()?;
    bench.clear()?;
    let whole = bench.record(None)?;
    eprintln!("{:.1} Hz, {} frames", whole.rate_hz, whole.frames);
    let results = Results {
        command: format!(
            "cargo xtask bench recording --kills {} --seed {}",
            options.kills, options.seed
        ),
        provenance: "emulated".to_owned(),
        whole,
        faults: faults::run(&bench)?,
        kills: kills::run(&bench, options.kills, options.seed)?,
    };
    let figures = serde_json::to_string_pretty(&results)? + "\n";
    write_whole(&Path::new(RESULTS).join("recording.json"), figures.as_bytes())?;
    let page = page::markdown(&results);
    write_whole(&Path::new(RESULTS).join("recording.md"), page.as_bytes())?;
    let is_sound = results.whole.lost_unmarked == 0
        && results.faults.iter().all(faults::Outcome::is_sound)
        && results.kills.is_sound();
    ensure!(
        is_sound,
        "see {RESULTS}/recording.md: readings were lost and not marked, or a fault did not end as required"
    );
    Ok(())
}
