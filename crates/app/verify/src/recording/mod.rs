//! What a recording on the emulated bench is worth: its rate, what each fault does to it, and what a kill leaves. Through the command,
//! as its users have it: `cargo xtask bench recording`.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

mod faults;
mod kills;
mod page;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use twintac_log::{Body, Event, LogReader};

use crate::files::write_whole;

/// Where the results go.
const RESULTS: &str = "docs/benchmarks";
/// Where the runs go.
const WORK: &str = "target/bench-recording";

/// A press that is long enough for any fault to show.
const PROTOCOL: &str = r#"summary = "Two presses, held for three seconds"
indenters = ["sphere-25"]
places = { kind = "grid", x_mm = [-4.0, 4.0], y_mm = [0.0, 0.0], count = [2, 1] }
depth_mm = 1.0
speed_mm_per_s = 4.0
hold_s = 3.0
clearance_mm = 0.6
"#;

/// All that was found.
#[derive(Serialize, Deserialize)]
struct Results {
    command: String,
    provenance: String,
    /// A run in which nothing goes wrong.
    whole: Summary,
    faults: Vec<faults::Outcome>,
    kills: kills::Kills,
}

/// The last line of `twintac record --json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Summary {
    rate_hz: f64,
    frames: u64,
    lost_unmarked: u64,
    presses: usize,
    presses_done: usize,
    stopped: Option<String>,
    stop_latency_periods: Option<f64>,
}

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
        kills: kills::run(&bench, options)?,
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

/// The command and its folders.
struct LabBench {
    program: PathBuf,
    out: PathBuf,
    protocol: PathBuf,
}

impl LabBench {
    fn new() -> Result<Self> {
        let work = Path::new(WORK);
        std::fs::create_dir_all(work).with_context(|| format!("creating {WORK}"))?;
        let protocol = work.join("protocol.toml");
        write_whole(&protocol, PROTOCOL.as_bytes())?;
        let program = std::env::current_exe()?.with_file_name("twintac");
        ensure!(
            program.exists(),
            "{} is missing: `cargo build --release -p twintac`",
            program.display()
        );
        Ok(Self {
            program,
            out: work.join("run"),
            protocol,
        })
    }

    /// Forgets the logs, and keeps what the emulated gel answers.
    fn clear(&self) -> Result<()> {
        match std::fs::remove_dir_all(self.logs()) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error.into()),
            _ => Ok(()),
        }
    }

    fn logs(&self) -> PathBuf {
        self.out.join("logs")
    }

    fn command(&self, faults: Option<&Path>) -> Command {
        let mut command = Command::new(&self.program);
        command.args(["record", "--lab", "--json", "--protocol"]);
        command.arg(&self.protocol).arg("--out").arg(&self.out);
        if let Some(faults) = faults {
            command.arg("--faults").arg(faults);
        }
        command.stdin(Stdio::null()).stderr(Stdio::piped());
        command
    }

    /// Records to the end, or to where the bench is stopped.
    fn record(&self, faults: Option<&Path>) -> Result<Summary> {
        let output = self.command(faults).output().context("starting twintac")?;
        let said = String::from_utf8_lossy(&output.stdout);
        let line = said.lines().last().unwrap_or_default();
        serde_json::from_str(line)
            .with_context(|| format!("{line}{}", String::from_utf8_lossy(&output.stderr)))
    }

    /// All logs of the run, those that were set aside too, sorted by name.
    fn log_files(&self) -> Result<Vec<PathBuf>> {
        let mut files = Vec::new();
        let Ok(entries) = std::fs::read_dir(self.logs()) else {
            return Ok(files); // killed before it made the folder
        };
        for entry in entries {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if name.contains(".mcap") {
                files.push(path);
            }
        }
        files.sort();
        Ok(files)
    }
}

/// What a log says happened, and when its last message came.
struct Reading {
    events: Vec<Event>,
    frames: u64,
    /// Wall-clock time of the last message, ns since 1970.
    last_unix_ns: Option<u64>,
}

fn read(log: &Path) -> Result<Reading> {
    let mut reader = LogReader::open(log)?;
    let start_unix_ns = reader.description().start_unix_ns;
    let mut reading = Reading {
        events: Vec::new(),
        frames: 0,
        last_unix_ns: None,
    };
    for message in reader.by_ref() {
        let message = message?;
        reading.last_unix_ns = reading.last_unix_ns.max(Some(start_unix_ns + message.bench_ns));
        match message.body {
            Body::Event(event) => reading.events.push(event),
            Body::Tactile(_) => reading.frames += 1,
            _ => {}
        }
    }
    Ok(reading)
}
