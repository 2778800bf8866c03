//! What a recording on the emulated bench is worth: its rate, what each fault does to it, and what a kill leaves. Through the command,
//! as its users have it: `cargo xtask bench recording`.

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

/// Where the results go.
const RESULTS: &str = "docs/benchmarks";

#[derive(clap::Args)]
pub(crate) struct Options {
    /// Recordings to kill.
    #[arg(long, default_value_t = 50)]
    kills: usize,
    /// Seed of the moments at which they are killed.
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
        "see {RESULTS}/recording.md: something was lost in silence, or a fault did not end as it must"
    );
    Ok(())
}
