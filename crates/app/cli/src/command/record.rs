//! `twintac record`: carries presses out on a bench, and records them.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use anyhow::{Context, Result, anyhow};
use serde::Serialize;
use twintac_lab::EmulatorConfiguration;
use twintac_press::{Mounting, PressSettings, RunSummary, check_folder, sensor_limits};
use twintac_protocol::PressPlan;
use twintac_recording::Provenance;
use twintac_run::built_in::{LAB_RIG, emulator};
use twintac_run::{Run, check_logs};
use twintac_sensor::SensorFile;
use twintac_source::Known;
use twintac_station::{OpenBench, preview, read_faults};
use twintac_work::{Caller, Planned, Progress};

use super::files::sensor_or_phystac;
use super::reproduce::settings;
use crate::Program;
use crate::arguments::Record;
use crate::output::print;
use crate::progress::say;

/// Set by Ctrl-C. It stops the bench.
static INTERRUPT: AtomicBool = AtomicBool::new(false);

/// A run was stopped before its end, safely and for a reason. What was recorded is kept.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct Stopped(String);

/// The last line of the output with `--json`.
#[derive(Debug, Serialize)]
struct Summary {
    rate_hz: f64,
    frames: u64,
    lost_unmarked: u64,
    presses: usize,
    presses_done: usize,
    stopped: Option<String>,
    stop_latency_periods: Option<f64>,
    provenance: Provenance,
}

pub(super) fn run(arguments: &Record, program: &Program) -> Result<()> {
    let sensor = sensor_or_phystac(arguments.sensor.as_deref())?;
    let planned = Planned::read(&arguments.protocol, &sensor.sensor, arguments.start.seed)?;
    let emulator = arguments.lab.as_ref().map(|named| emulator(named.as_deref()));
    let emulator = emulator.transpose()?;
    if let (Some(emulator), true) = (&emulator, arguments.at_once) {
        let n_presses = planned.presses.len() + planned.loads.len();
        let source = format!("{n_presses} presses on the emulated bench");
        let run = start(arguments, sensor, &source, program.caller()?)?;
        return Ok(run.emulate(emulator, &planned)?);
    }
    let n_loads = planned.loads.len();
    if n_loads > 0 {
        say(&format!(
            "{n_loads} loads of the protocol are left out: the robot cannot place weights"
        ));
    }
    let settings = press_settings(arguments.bench.as_deref())?;
    let plans = planned.presses;
    if arguments.dry_run {
        return dry_run(arguments, &settings, &plans, &sensor);
    }
    sensor_limits(&sensor.sensor)?;
    press(arguments, (sensor, settings), emulator.as_ref(), &plans, program)
}

/// Folder of the run.
fn out(arguments: &Record) -> PathBuf {
    let usual = || Path::new("runs").join(arguments.protocol.file_stem().unwrap_or_default());
    arguments.out.clone().unwrap_or_else(usual)
}

fn start(arguments: &Record, sensor: SensorFile, source: &str, caller: Caller) -> Result<Run> {
    let settings = settings(&arguments.start)?;
    let seed = arguments.start.seed;
    Ok(Run::start(
        &out(arguments),
        sensor,
        source,
        seed,
        settings,
        caller,
    )?)
}

/// Prints and draws what would be done.
fn dry_run(
    arguments: &Record,
    settings: &PressSettings,
    plans: &[PressPlan],
    sensor: &SensorFile,
) -> Result<()> {
    let preview = preview(settings, plans, &sensor.sensor, &out(arguments).join("plan"))?;
    if arguments.json {
        return print(&serde_json::to_string(&preview)?);
    }
    print(&format!(
        "{} presses with {} indenters take {}, without the time to change indenters",
        preview.presses,
        preview.indenters,
        preview.duration()
    ))?;
    let drawings: Vec<String> = preview
        .drawings
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    print(&format!("drawings {}", drawings.join(" ")))
}

/// Carries the presses out, and stops at Ctrl-C.
fn press(
    arguments: &Record,
    (sensor, settings): (SensorFile, PressSettings),
    emulator: Option<&EmulatorConfiguration>,
    plans: &[PressPlan],
    program: &Program,
) -> Result<()> {
    let faults = arguments.faults.as_deref().map(read_faults).transpose()?;
    let whose = if emulator.is_some() {
        "the emulated bench"
    } else {
        settings
            .real_devices()
            .map_err(|error| anyhow!("{error} with `--lab`"))?;
        "a real test setup"
    };
    let folder = out(arguments);
    check_logs(&folder, &sensor, emulator, &settings)?;
    check_folder(&folder.join("logs"), plans)?;
    let source = format!("{} presses on {whose}, over its interfaces", plans.len());
    let caller = program.caller()?;
    let run = start(arguments, sensor, &source, caller.clone())?;
    let mut bench = match emulator {
        Some(emulator) => run.emulated_bench(emulator, plans, &settings, faults.unwrap_or_default())?,
        None => {
            let known = Known {
                counts_per_pa: arguments.scale,
                altitude_m: arguments.altitude_m,
            };
            OpenBench::connect(&run.sensor().sensor, &settings, &known)?
        }
    };
    for note in bench.notes() {
        say(note);
    }
    ctrlc::set_handler(|| INTERRUPT.store(true, Ordering::Relaxed)).context("listening to Ctrl-C")?;
    let mut answer = None;
    let mut mount = |indenter: &str| mount(indenter, &mut answer, &*caller.progress);
    let summary = run.press(&mut bench, settings, plans, &INTERRUPT, &mut mount)?;
    tell(&summary, plans.len(), &run, bench.provenance(), arguments.json)
}

/// Asks a person to mount an indenter. `answer` receives the person's answer, once asked.
fn mount(indenter: &str, answer: &mut Option<Receiver<bool>>, progress: &dyn Progress) -> Mounting {
    let asked = answer.get_or_insert_with(|| ask_for(indenter, progress));
    let mounting = match asked.try_recv() {
        Ok(true) => Mounting::Mounted,
        Err(TryRecvError::Empty) => return Mounting::Waiting,
        Ok(false) | Err(TryRecvError::Disconnected) => {
            progress.note("there is no answer on standard input, so the indenter counts as not mounted");
            Mounting::Refused
        }
    };
    *answer = None;
    mounting
}

/// Asks a person to mount an indenter. The receiver gets `true` for an answer, and `false` if
/// nobody can answer any more.
fn ask_for(indenter: &str, progress: &dyn Progress) -> Receiver<bool> {
    progress.note(&format!(
        "The robot is enabled and does not move. Mount the indenter `{indenter}`, step back, and press Enter: the robot will move. Ctrl-C ends the run."
    ));
    let (sender, answer) = channel();
    std::thread::spawn(move || {
        let read = std::io::stdin().read_line(&mut String::new());
        let _ = sender.send(matches!(read, Ok(bytes) if bytes > 0)); // after Ctrl-C no receiver is left
    });
    answer
}

fn tell(summary: &RunSummary, presses: usize, run: &Run, provenance: Provenance, json: bool) -> Result<()> {
    let stopped = summary.stopped.as_ref().map(ToString::to_string);
    if json {
        print(&serde_json::to_string(&Summary {
            rate_hz: summary.rate_hz,
            frames: summary.frames,
            lost_unmarked: summary.lost_unmarked,
            presses,
            presses_done: summary.presses_done,
            stopped: stopped.clone(),
            stop_latency_periods: summary.stop_latency_periods,
            provenance,
        })?)?;
    } else {
        print(&format!(
            "{} of {presses} presses are done ({} data): {} frames at {:.1} Hz, {} lost and not marked",
            summary.presses_done, provenance, summary.frames, summary.rate_hz, summary.lost_unmarked
        ))?;
        print(&format!("logs    {}", run.logs_folder().display()))?;
    }
    match stopped {
        None => Ok(()),
        Some(cause) => Err(Stopped(format!(
            "the test setup was stopped: {cause}. The recorded presses are kept; the same command continues with the next press"
        ))
        .into()),
    }
}

fn press_settings(file: Option<&Path>) -> Result<PressSettings> {
    let (name, text) = LAB_RIG.unless(file)?;
    Ok(PressSettings::parse(&name, &text)?)
}
