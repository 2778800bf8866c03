//! Processes that measure, one at a time, on two processors.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};
use serde_json::{Map, json};

use super::plan::{Engine, Run};
use super::row::{Figures, Row};

/// Folder of the scripts.
const SCRIPTS: &str = "crates/app/verify/peers";

/// Wall time allowed for starting an engine and compiling its kernels, s.
const START_UP_S: f64 = 600.0;

/// A virtual environment with the other engines.
pub(super) struct Python {
    program: PathBuf,
    work: PathBuf,
}

impl Python {
    /// Makes the environment, or reuses it if it matches the packages.
    pub(super) fn prepare(work: &Path, packages: &[String]) -> Result<Self> {
        let venv = work.join("venv");
        let python = Python {
            program: std::path::absolute(venv.join("bin/python"))?,
            work: work.to_owned(),
        };
        if !python.program.exists() {
            succeed(Command::new("python3").args(["-m", "venv"]).arg(&venv))?;
        }
        let mut install = Command::new(&python.program);
        install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
        succeed(install.args(packages))?;
        Ok(python)
    }

    /// Time of an engine's very first start, during which it compiles its kernels, s. Later starts
    /// reuse them.
    pub(super) fn first_start(&self, engine: &Engine, runs: &[Run]) -> Option<f64> {
        let mut run = runs.first()?.clone();
        eprintln!("{}, first start", engine.name);
        let _ = std::fs::remove_dir_all(self.kernels());
        run.parameters.remove("mesh_file");
        run.parameters.insert("cells".into(), json!([6, 4, 2]));
        run.parameters.insert("limit_s".into(), json!(0.0));
        self.figures(&run).ok().map(|figures| figures.start_up_s)
    }

    /// Runs a press, and returns its row.
    pub(super) fn row(&self, run: &Run, first_start_s: Option<f64>) -> Row {
        match self.figures(run) {
            Ok(figures) => Row::measured(run, figures, first_start_s),
            Err(error) => Row::failed(run, &format!("{error:#}")),
        }
    }

    fn kernels(&self) -> PathBuf {
        self.work.join("kernels")
    }

    fn figures(&self, run: &Run) -> Result<Figures> {
        let mut command = on_two_processors(&self.program);
        command
            .arg(std::path::absolute(Path::new(SCRIPTS).join(&run.script))?)
            .arg(serde_json::to_string(&run.parameters)?)
            .current_dir(&self.work) // engines leave logs in their working directory
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .env("WARP_CACHE_PATH", std::path::absolute(self.kernels())?);
        measured(
            command,
            &self.work.join("log.txt"),
            START_UP_S + 5.0 * run.limit_s,
        )
    }
}

/// The run of this project's solver, in a process of its own like the others.
pub(super) fn ours(work: &Path, poissons_ratio: f64) -> Row {
    let run = Run {
        engine: "TwinTac".into(),
        version: env!("CARGO_PKG_VERSION").into(),
        script: String::new(),
        setting: "real time".into(),
        mesh: "TwinTac's".into(),
        poissons_ratio,
        parameters: Map::new(),
        limit_s: START_UP_S,
    };
    let figures = std::env::current_exe().map_err(Into::into).and_then(|program| {
        let mut command = on_two_processors(&program);
        command.args(["press", "--poissons-ratio", &poissons_ratio.to_string()]);
        measured(command, &work.join("log.txt"), run.limit_s)
    });
    match figures {
        Ok(figures) => Row::measured(&run, figures, None),
        Err(error) => Row::failed(&run, &format!("{error:#}")),
    }
}

/// The printed figures of a process. Its other messages go to a log, whose last line is the reason
/// if it fails.
fn measured(mut command: Command, log: &Path, limit_s: f64) -> Result<Figures> {
    let file = File::create(log).with_context(|| format!("creating {}", log.display()))?;
    let mut child = command.stdout(Stdio::piped()).stderr(file).spawn()?;
    let started = Instant::now();
    while child.try_wait()?.is_none() {
        if started.elapsed().as_secs_f64() > limit_s {
            child.kill()?;
            child.wait()?;
            bail!("not done after {limit_s:.0} s");
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let output = child.wait_with_output()?;
    if !output.status.success() {
        let talk = std::fs::read_to_string(log).unwrap_or_default();
        let last = talk.lines().rev().find(|line| !line.trim().is_empty());
        bail!("{}: {}", output.status, last.unwrap_or("it gave no reason"));
    }
    Figures::parse(&String::from_utf8_lossy(&output.stdout))
}

/// A command that is restricted to two processors, and to two threads in libraries with such a
/// setting.
fn on_two_processors(program: &Path) -> Command {
    let pin = Command::new("taskset")
        .arg("--version")
        .stdout(Stdio::null())
        .status();
    let mut command = if pin.is_ok_and(|status| status.success()) {
        let mut command = Command::new("taskset");
        command.args(["--cpu-list", "0,1"]).arg(program);
        command
    } else {
        Command::new(program)
    };
    command
        .env("OMP_NUM_THREADS", "2")
        .env("OPENBLAS_NUM_THREADS", "2");
    command
}

fn succeed(command: &mut Command) -> Result<()> {
    let output = command
        .output()
        .with_context(|| format!("starting {command:?}"))?;
    if !output.status.success() {
        let talk = String::from_utf8_lossy(&output.stderr);
        bail!("{}", talk.lines().last().unwrap_or("no reason given"));
    }
    Ok(())
}

/// The machine and the time of the measurement.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct Conditions {
    pub(super) date: String,
    pub(super) processor: String,
    pub(super) processors: usize,
    pub(super) memory_gib: f64,
    /// Load average of the last fifteen minutes. The part above two was other work.
    pub(super) load: f64,
    /// The command.
    pub(super) command: String,
    /// Processor time after which presses of the other engines were cut, s.
    pub(super) limit_s: f64,
}

/// Describes this machine and the present time.
pub(super) fn conditions(limit_s: f64) -> Conditions {
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let field = |text: &str, name: &str| {
        let line = text.lines().find(|line| line.starts_with(name))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    let memory = field(&read("/proc/meminfo"), "MemTotal");
    let memory_kib = memory.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    let date = Command::new("date").args(["-u", "+%Y-%m-%d %H:%M UTC"]).output();
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    Conditions {
        date: date.map_or_else(
            |_| String::new(),
            |out| String::from_utf8_lossy(&out.stdout).trim().into(),
        ),
        processor: field(&read("/proc/cpuinfo"), "model name").unwrap_or_else(|| "unknown".into()),
        processors: std::thread::available_parallelism().map_or(0, Into::into),
        memory_gib: memory_kib.unwrap_or(0.0) / f64::from(1 << 20),
        load: read("/proc/loadavg")
            .split_whitespace()
            .nth(2)
            .and_then(|text| text.parse().ok())
            .unwrap_or(0.0),
        command: format!("cargo xtask bench {}", arguments.join(" ")),
        limit_s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Result<Figures> {
        let folder = tempfile::tempdir()?;
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        measured(command, &folder.path().join("log.txt"), 0.5)
    }

    #[test]
    fn a_process_that_fails_says_why() {
        let error = shell("echo no such module >&2; exit 1").unwrap_err();
        assert!(error.to_string().contains("no such module"), "{error}");
    }

    #[test]
    fn a_process_that_hangs_is_ended() {
        let error = shell("exec sleep 60").unwrap_err();
        assert!(error.to_string().contains("not done"), "{error}");
    }
}
