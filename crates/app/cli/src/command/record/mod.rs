//! `twintac record`: presses on a bench, over its wires.

mod preview;

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use anyhow::{Context, Result};
use indicatif::ProgressBar;
use serde::Serialize;
use twintac_lab::{Reality, Selector};
use twintac_live::Known;
use twintac_log::Description;
use twintac_press::{Mounting, Operator, PressSettings, RunSummary, Runner, sensor_limits};
use twintac_protocol::PressPlan;
use twintac_recording::Provenance;
use twintac_rig::xarm::Client;

use crate::arguments::Record;
use twintac_run::bench::{self, OpenBench, lab};
use twintac_run::built_in::{LAB_BENCH, REALITY};
use twintac_run::progress::{self, say};
use twintac_run::run::Run;
use twintac_run::sensor_file::SensorFile;
use twintac_run::settings::RunSettings;
use twintac_run::stages::recordings::{plan, plan_loads};

/// Set by Ctrl-C: the bench stops.
static INTERRUPT: AtomicBool = AtomicBool::new(false);

/// A run was stopped before its end, safely and for a reason; what was recorded is kept.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct Stopped(String);

/// The last line with `--json`.
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

pub(super) fn run(arguments: &Record) -> Result<()> {
    let sensor = SensorFile::or_phystac(arguments.sensor.as_deref())?;
    let seed = arguments.start.seed;
    let plans = plan(&arguments.protocol, &sensor.sensor, seed)?;
    let loads = plan_loads(&arguments.protocol, &sensor.sensor, seed)?;
    let reality = arguments.lab.as_ref().map(|file| read_reality(file.as_deref()));
    let reality = reality.transpose()?;
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => Path::new("runs").join(arguments.protocol.file_stem().unwrap_or_default()),
    };
    if let (Some(reality), true) = (&reality, arguments.at_once) {
        let source = format!("{} presses on the emulated bench", plans.len() + loads.len());
        let settings = RunSettings::read(arguments.start.settings.as_deref())?;
        return Run::start(&out, sensor, source, seed, settings)?.record(reality, &plans, &loads);
    }
    if !loads.is_empty() {
        say(&format!(
            "{} loads of the protocol are left out: no robot puts weights on",
            loads.len()
        ));
    }
    let settings = press_settings(arguments.bench.as_deref())?;
    if arguments.dry_run {
        return preview::run(&settings, &plans, &sensor.sensor, &out, arguments.json);
    }
    let limits = sensor_limits(&sensor.sensor)?;
    let faults = match &arguments.faults {
        Some(file) => lab::read_faults(file)?,
        None => Vec::new(),
    };
    if reality.is_none() {
        settings.real_devices()?;
    }
    twintac_press::check_folder(&out.join("logs"), &plans)?;
    let whose = if reality.is_some() {
        "the emulated"
    } else {
        "a real"
    };
    let source = format!("{} presses on {whose} bench, over its wires", plans.len());
    let run = Run::start(
        &out,
        sensor,
        source,
        seed,
        RunSettings::read(arguments.start.settings.as_deref())?,
    )?;
    let mut bench = match &reality {
        Some(reality) => lab::open(&run, reality, &plans, &settings, faults)?,
        None => {
            let known = Known {
                counts_per_pa: arguments.scale,
                altitude_m: arguments.altitude_m,
            };
            bench::open_real(&run.sensor.sensor, &settings, &known)?
        }
    };
    for note in &bench.notes {
        say(note);
    }
    let runner = Runner::new(settings, limits, description(&run.sensor, &bench))?;
    let summary = press_all(&runner, &mut bench, &plans, &run.folder.join("logs"))?;
    if summary.presses_done > 0 {
        run.collect(&run.folder.join("logs"), &plans)?;
    }
    tell(&summary, plans.len(), &bench, &run.folder, arguments.json)
}

/// Carries the presses out, with a bar, and stops on Ctrl-C and when it is told to end.
fn press_all(runner: &Runner, bench: &mut OpenBench, plans: &[PressPlan], logs: &Path) -> Result<RunSummary> {
    ctrlc::set_handler(|| INTERRUPT.store(true, Ordering::Relaxed)).context("listening to Ctrl-C")?;
    let bar = progress::bar("pressing", plans.len() as u64);
    let mut attendant = Attendant {
        bar: &bar,
        selector: bench.selector.as_ref(),
        answer: None,
    };
    let summary = runner.run(&mut bench.devices, plans, logs, &INTERRUPT, &mut attendant)?;
    bar.finish_and_clear();
    for remark in &summary.remarks {
        say(remark);
    }
    if !summary.is_stop_confirmed {
        say(&stop_anew(bench.robot));
    }
    Ok(summary)
}

/// Stops a robot that did not confirm its stop over a connection of its own; how that went.
fn stop_anew(robot: SocketAddr) -> String {
    match Client::connect(robot).and_then(|mut robot| robot.stop()) {
        Ok(()) => "the robot was stopped over a second connection".to_owned(),
        Err(error) => {
            format!(
                "the robot may still be pressing and cannot be told to stop ({error}): press its emergency stop"
            )
        }
    }
}

/// Has indenters mounted: by a person, or in the lab by itself.
struct Attendant<'a> {
    bar: &'a ProgressBar,
    selector: Option<&'a Selector>,
    /// Whether the person who was asked has answered: `true`, or nobody can any more.
    answer: Option<Receiver<bool>>,
}

impl Operator for Attendant<'_> {
    fn mount(&mut self, indenter: &str) -> Mounting {
        if self.selector.is_some() {
            return Mounting::Mounted;
        }
        let bar = self.bar;
        let answer = self
            .answer
            .get_or_insert_with(|| bar.suspend(|| ask_for(indenter)));
        let mounting = match answer.try_recv() {
            Ok(true) => Mounting::Mounted,
            Err(TryRecvError::Empty) => return Mounting::Waiting,
            Ok(false) | Err(TryRecvError::Disconnected) => {
                say("nobody answers on standard input, so the indenter counts as not mounted");
                Mounting::Refused
            }
        };
        self.answer = None;
        mounting
    }

    fn begin(&mut self, index: usize, plan: &PressPlan) {
        self.bar.set_position(index as u64);
        if let Some(selector) = self.selector {
            // The tables are those of the same plans.
            let _ = selector.select(&plan.name);
        }
    }
}

/// Asks a person to mount an indenter; whether there was an answer comes later.
fn ask_for(indenter: &str) -> Receiver<bool> {
    say(&format!(
        "The robot is switched on and stands. Mount the indenter `{indenter}`, step back, and press Enter: it will move. Ctrl-C ends the run."
    ));
    let (sender, answer) = channel();
    std::thread::spawn(move || {
        let read = std::io::stdin().read_line(&mut String::new());
        let _ = sender.send(matches!(read, Ok(bytes) if bytes > 0)); // nobody listens any more after Ctrl-C
    });
    answer
}

fn tell(summary: &RunSummary, presses: usize, bench: &OpenBench, folder: &Path, json: bool) -> Result<()> {
    let stopped = summary.stopped.as_ref().map(ToString::to_string);
    if json {
        super::print(&serde_json::to_string(&Summary {
            rate_hz: summary.rate_hz,
            frames: summary.frames,
            lost_unmarked: summary.lost_unmarked,
            presses,
            presses_done: summary.presses_done,
            stopped: stopped.clone(),
            stop_latency_periods: summary.stop_latency_periods,
            provenance: bench.provenance,
        })?)?;
    } else {
        super::print(&format!(
            "{} of {presses} presses are done ({} data): {} frames at {:.1} Hz, {} lost without a mark",
            summary.presses_done, bench.provenance, summary.frames, summary.rate_hz, summary.lost_unmarked
        ))?;
        super::print(&format!("logs    {}", folder.join("logs").display()))?;
    }
    match stopped {
        None => Ok(()),
        Some(cause) => Err(Stopped(format!(
            "the bench was stopped: {cause}. What was recorded is kept; the same command goes on with the next press"
        ))
        .into()),
    }
}

fn description(sensor: &SensorFile, bench: &OpenBench) -> Description {
    Description {
        sensor: sensor.sensor.name.clone(),
        sensor_toml: sensor.text.clone(),
        provenance: bench.provenance,
        taxels: sensor
            .sensor
            .taxels
            .iter()
            .map(|taxel| taxel.name.clone())
            .collect(),
        transfer: Some(twintac_live::confirmed_transfer(&bench.transfer)),
        // Set by the run.
        base_from_gel: twintac_shape::Pose::IDENTITY,
        tool_from_indenter: twintac_shape::Pose::IDENTITY,
        force_axis: glam::DVec3::NEG_Z,
        start_unix_ns: 0,
        versions: BTreeMap::from([("twintac".to_owned(), env!("CARGO_PKG_VERSION").to_owned())]),
    }
}

fn press_settings(file: Option<&Path>) -> Result<PressSettings> {
    let (name, text) = LAB_BENCH.unless(file)?;
    Ok(PressSettings::parse(&name, &text)?)
}

fn read_reality(file: Option<&Path>) -> Result<Reality> {
    let (name, text) = REALITY.unless(file)?;
    Ok(Reality::parse(&name, &text)?)
}
