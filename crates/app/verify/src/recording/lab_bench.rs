//! Runs the command on the emulated bench, and reads its logs.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use twintac_log::{Body, Event, LogReader};

use crate::files::write_whole;

/// Folder of the runs.
pub(super) const WORK: &str = "target/bench-recording";

/// A protocol whose presses are long enough for every fault.
const PROTOCOL: &str = r#"summary = "Two presses, held for three seconds"
indenters = ["sphere-25"]
places = { kind = "grid", x_mm = [-4.0, 4.0], y_mm = [0.0, 0.0], count = [2, 1] }
depth_mm = 1.0
speed_mm_per_s = 4.0
hold_s = 3.0
clearance_mm = 0.6
"#;

/// The last line of `twintac record --json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Summary {
    pub(super) rate_hz: f64,
    pub(super) frames: u64,
    pub(super) lost_unmarked: u64,
    pub(super) presses: usize,
    pub(super) presses_done: usize,
    pub(super) stopped: Option<String>,
    pub(super) stop_latency_periods: Option<f64>,
}

/// The command and its folders.
pub(super) struct LabBench {
    program: PathBuf,
    out: PathBuf,
    protocol: PathBuf,
}

impl LabBench {
    pub(super) fn new() -> Result<Self> {
        let work = Path::new(WORK);
        std::fs::create_dir_all(work).with_context(|| format!("creating {WORK}"))?;
        let protocol = work.join("protocol.toml");
        write_whole(&protocol, PROTOCOL.as_bytes())?;
        let program = std::env::current_exe()?.with_file_name("twintac");
        ensure!(
            program.exists(),
            "{} is missing: `cargo build --release -p twintac-cli`",
            program.display()
        );
        Ok(Self {
            program,
            out: work.join("run"),
            protocol,
        })
    }

    /// Removes the logs, and keeps the computed responses of the emulated gel.
    pub(super) fn clear(&self) -> Result<()> {
        match std::fs::remove_dir_all(self.logs()) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error.into()),
            _ => Ok(()),
        }
    }

    fn logs(&self) -> PathBuf {
        self.out.join("logs")
    }

    pub(super) fn command(&self, faults: Option<&Path>) -> Command {
        let mut command = Command::new(&self.program);
        command.args(["record", "--lab", "--json", "--protocol"]);
        command.arg(&self.protocol).arg("--out").arg(&self.out);
        if let Some(faults) = faults {
            command.arg("--faults").arg(faults);
        }
        command.stdin(Stdio::null()).stderr(Stdio::piped());
        command
    }

    /// Records to the end, or until the bench is stopped.
    pub(super) fn record(&self, faults: Option<&Path>) -> Result<Summary> {
        let output = self.command(faults).output().context("starting twintac")?;
        let said = String::from_utf8_lossy(&output.stdout);
        let line = said.lines().last().unwrap_or_default();
        serde_json::from_str(line)
            .with_context(|| format!("{line}{}", String::from_utf8_lossy(&output.stderr)))
    }

    /// All logs of the run, including those that were set aside, sorted by name.
    pub(super) fn log_files(&self) -> Result<Vec<PathBuf>> {
        let mut files = Vec::new();
        let Ok(entries) = std::fs::read_dir(self.logs()) else {
            return Ok(files); // the command was killed before it made the folder
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

/// The events of a log, its number of frames, and the time of its last message.
pub(super) struct Reading {
    pub(super) events: Vec<Event>,
    pub(super) frames: u64,
    /// Wall-clock time of the last message, ns since 1970.
    pub(super) last_unix_ns: Option<u64>,
}

/// Reads a log to its end.
pub(super) fn read(log: &Path) -> Result<Reading> {
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
