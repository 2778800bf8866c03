//! Runs on the emulated devices, in real time and over their sockets: what is recorded, and the
//! effect of each fault.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // also in the helpers of tests; figures for people to read

use std::collections::BTreeMap;
use std::net::TcpStream;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use glam::{DQuat, DVec3};
use phystac::recovery::{free_bus, reset_switch};
use phystac::{PhysTac, Thresholds, Transfer};
use tempfile::TempDir;
use twintac_emulate::{
    EmulatedBench, EmulatedBenchSettings, FaultKind, Hertz, LabClock, Moment, ScheduledFault,
};
use twintac_log::{
    Body, Description, Ending, Event, LogReader, ReadOptions, Stream, TaxelState, read_presses,
};
use twintac_press::{
    Bench, Mounting, Operator, PressError, PressSettings, RunSummary, Runner, Streams, dry_run,
};
use twintac_protocol::PressPlan;
use twintac_recording::Provenance;
use twintac_rig::xarm::{Client, ReportPort, ReportReader};
use twintac_rig::{BenchClock, Cause, NetFtSource, SensorLimits, netft};
use twintac_source::{FrameReader, PowerOn, confirmed_transfer};

const LIMITS: SensorLimits = SensorLimits {
    force_n: 20.0,
    depth_mm: 4.0,
};

/// A wait that is longer than any delay of a busy machine.
const LATEST: Duration = Duration::from_secs(60);

/// Allowed silences are as long as that, and any loss is tolerated.
fn press_settings() -> PressSettings {
    let settings = PressSettings::parse("bench.toml", include_str!("bench.toml")).unwrap();
    PressSettings {
        tolerated_loss: u32::MAX,
        ..settings
    }
}

fn description(provenance: Provenance) -> Description {
    let placement = press_settings().placement;
    Description {
        sensor: "test".to_owned(),
        sensor_toml: String::new(),
        provenance,
        taxels: (0..8).map(|taxel| format!("S{taxel}")).collect(),
        transfer: Some(confirmed_transfer(&Transfer::per_pa(32))),
        base_from_gel: placement.base_from_gel,
        tool_from_indenter: placement.tool_from_indenter,
        force_axis: placement.force_axis,
        start_unix_ns: 0,
        versions: BTreeMap::new(),
    }
}

fn runner() -> Runner {
    Runner::new(press_settings(), LIMITS, description(Provenance::Emulated)).unwrap()
}

#[test]
fn a_real_bench_that_is_not_watched_closely_presses_nothing() {
    let refused = Runner::new(press_settings(), LIMITS, description(Provenance::Real)).unwrap_err();
    assert!(
        refused.to_string().contains("`force_silence_s` is 60"),
        "{refused}"
    );
}

fn plans(count: usize) -> Vec<PressPlan> {
    held_plans(count, 0.3)
}

fn held_plans(count: usize, hold_s: f64) -> Vec<PressPlan> {
    let plan = |index: usize| PressPlan {
        name: format!("ball#{index:03}"),
        indenter: "ball".to_owned(),
        x_mm: index as f64 - 1.0,
        y_mm: 0.5,
        rotation: DQuat::from_rotation_z(0.1 * index as f64),
        clearance_mm: 0.5,
        depth_mm: 1.0,
        speed_mm_per_s: 6.0,
        hold_s,
    };
    (0..count).map(plan).collect()
}

/// The emulated devices and their clients.
fn bench() -> (EmulatedBench, Bench<Client<TcpStream>>) {
    let clock = LabClock::real();
    let mut settings = EmulatedBenchSettings::default();
    settings.robot.first_pose.position_mm = DVec3::new(199.0, 0.0, 103.0);
    settings.force.zero = [0.1, -0.1, 0.3, 0.0, 0.0, 0.0];
    let devices = EmulatedBench::start(clock.clone(), Hertz::default(), &settings).unwrap();
    let bench_clock = BenchClock::start();
    let mut streams = Streams::new(bench_clock);
    let configuration = devices.force.with_sensor(|sensor| sensor.configuration().clone());
    let mut force = netft::Client::connect(devices.force.requests(), configuration).unwrap();
    force.set_patience(LATEST);
    force.start(false).unwrap();
    streams.hear_force(NetFtSource::new(force, bench_clock)).unwrap();
    let port = ReportPort::Development;
    let reports = TcpStream::connect(devices.robot.reports(port)).unwrap();
    streams.hear_robot(ReportReader::new(reports, port)).unwrap();
    let ((mut scl, mut sda), mut reset) = (devices.board.lines(), devices.board.reset_line());
    let free = move |_: &mut _, delay: &mut LabClock| {
        // A bus that stays hung also fails the next frame.
        let _ = reset_switch(&mut reset, delay);
        let _ = free_bus(&mut scl, &mut sda, delay);
    };
    let driver = phystac::Settings::<8> {
        conversion_us: press_settings().conversion_us,
        ..phystac::Settings::default()
    };
    let sensor = PhysTac::new(devices.board.bus(), clock, move || bench_clock.now_us(), driver);
    let checked = PowerOn {
        transfer: Some(Transfer::per_pa(32)),
        thresholds: Thresholds::default(),
        notes: Vec::new(),
    };
    let reader = FrameReader::new(sensor, &checked)
        .converting_ahead()
        .freed_by(free);
    streams.hear_taxels(reader).unwrap();
    let mut arm = Client::connect(devices.robot.commands()).unwrap();
    arm.set_answer_within(LATEST);
    arm.enable().unwrap();
    arm.begin_servo().unwrap();
    (devices, Bench { arm, streams })
}

fn run(bench: &mut Bench<Client<TcpStream>>, count: usize, out: &Path) -> RunSummary {
    let interrupt = AtomicBool::new(false);
    runner()
        .run(
            bench,
            &plans(count),
            out,
            &interrupt,
            &mut |_: usize, _: &PressPlan| {},
        )
        .unwrap()
}

/// The only complete log in a folder: its gaps and its notes.
fn log(out: &Path) -> (Vec<Event>, u64) {
    let mut names: Vec<_> = std::fs::read_dir(out)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "mcap"))
        .collect();
    assert_eq!(names.len(), 1, "{names:?}");
    let mut reader = LogReader::open(&names.remove(0)).unwrap();
    let (mut events, mut frames) = (Vec::new(), 0);
    for message in reader.by_ref() {
        match message.unwrap().body {
            Body::Event(event) => events.push(event),
            Body::Tactile(frame) => {
                frames += 1;
                let good = frame
                    .taxels
                    .iter()
                    .filter(|taxel| taxel.state == TaxelState::Good);
                for pressure_pa in good.map(|taxel| taxel.pressure_pa.unwrap()) {
                    let is_possible = (100_000.0..115_000.0).contains(&pressure_pa);
                    assert!(is_possible, "air and gel have no {pressure_pa} Pa");
                }
            }
            _ => {}
        }
    }
    assert_eq!(reader.ending(), Some(Ending::Whole));
    (events, frames)
}

fn gaps(events: &[Event], of: Stream) -> usize {
    let is_gap = |event: &&Event| matches!(event, Event::Gap { stream, .. } if *stream == Some(of));
    events.iter().filter(is_gap).count()
}

#[test]
fn presses_are_recorded_whole_and_a_second_run_goes_on_where_the_first_ended() {
    let folder = TempDir::new().unwrap();
    let (devices, mut bench) = bench();
    // The first run is interrupted when the second press begins.
    let interrupt = AtomicBool::new(false);
    let mut begun = 0;
    let first = runner()
        .run(
            &mut bench,
            &plans(2),
            folder.path(),
            &interrupt,
            &mut |index: usize, _: &PressPlan| {
                begun += 1;
                interrupt.store(index == 1, Ordering::Relaxed);
            },
        )
        .unwrap();
    assert_eq!((first.presses_done, begun), (1, 2));
    assert_eq!(first.stopped, Some(Cause::Operator));
    bench.arm.enable().unwrap();
    bench.arm.begin_servo().unwrap();
    let second = run(&mut bench, 2, folder.path());
    println!("{:.1} Hz, {first:?}, {second:?}", second.rate_hz);
    assert_eq!((second.presses_done, &second.stopped), (2, &None));
    assert_eq!((first.lost_unmarked, second.lost_unmarked), (0, 0));
    assert!(second.frames > 0, "{second:?}");
    assert!(
        devices.workcell().now().tool.position_mm.z > 102.0,
        "it ends above the gel"
    );

    let file = folder.path().join("press-0002.mcap");
    let read = read_presses(&file, &ReadOptions::default()).unwrap();
    let press = &read.recording.presses[0];
    assert_eq!(press.name, "ball#001");
    assert!(
        folder.path().join("press-0002.try-1.mcap").exists(),
        "the first try is kept"
    );

    // A third run has nothing left to do, and other presses do not match the folder.
    assert_eq!(run(&mut bench, 2, folder.path()).frames, 0);
    let other = runner().run(
        &mut bench,
        &plans(1),
        folder.path(),
        &AtomicBool::new(false),
        &mut |_: usize, _: &PressPlan| {},
    );
    assert!(matches!(other, Err(PressError::OtherRun { .. })));
}

#[test]
fn a_dry_run_ends_where_the_presses_do() {
    let settings = press_settings();
    let start = EmulatedBenchSettings::default().robot.first_pose;
    let dry = dry_run(&settings, &plans(3), &start).unwrap();
    let lowest = |press: &twintac_press::PlannedPress| {
        press
            .poses
            .iter()
            .map(|pose| pose.tool.position_mm.z)
            .fold(f64::INFINITY, f64::min)
    };
    for press in &dry.presses {
        assert!(
            (lowest(press) - 99.0).abs() < 6.0 * settings.servo_period_s,
            "{}",
            lowest(press)
        );
    }
    let total_s: f64 = dry.presses.iter().map(|press| press.duration_s).sum();
    assert!((total_s - dry.duration_s).abs() < 1e-9);
    let last = dry.presses[2].poses.last().unwrap().tool.position_mm;
    assert!(last.distance(DVec3::new(201.0, 0.5, 103.0)) < 0.1, "{last}");
}

/// The effect of a fault.
enum End {
    /// The press is done, and the log has gaps of this stream.
    Gap(Stream),
    /// The press is done, and the log notes that a taxel gives no reading.
    Note(&'static str),
    /// The press is done. If anything is missing, it is marked, as in every log.
    Done,
    /// The run stops, with these words in its cause.
    Stop(&'static str),
    /// The run stops after the silence of a device, with these words in its cause.
    Silence(&'static str),
}

/// One press for each fault, held long enough for any silence to show.
#[test]
fn each_fault_is_marked_or_stops_the_run() {
    let some_time = Some(Moment::TimeS(0.1));
    let some_datagrams = Some(Moment::Count(10));
    let whole_bus = FaultKind::NoAcknowledge { channel: None };
    let one_taxel = FaultKind::NoAcknowledge { channel: Some(2) };
    let stuck_bus = FaultKind::StuckBus { channel: None };
    let stuck_taxel = FaultKind::StuckBus { channel: Some(4) };
    let late = FaultKind::LateDatagrams { by_s: 0.02 };
    let short = FaultKind::Short { channel: 3 };
    let slow_bus = FaultKind::ClockStretch { by_s: 0.002 };
    let restarted = FaultKind::BarometerBrownOut { channel: 5 };
    let endless = FaultKind::EndlessConversion { channel: 1 };
    let table = [
        (one_taxel, None, End::Note("taxel 2 is missing")),
        (whole_bus, some_time, End::Gap(Stream::Tactile)),
        (whole_bus, None, End::Silence("the tactile sensor")),
        (stuck_bus, None, End::Gap(Stream::Tactile)),
        (stuck_taxel, None, End::Gap(Stream::Tactile)),
        (short, None, End::Note("taxel 3 is isolated")),
        (slow_bus, None, End::Gap(Stream::Tactile)),
        // The effect depends on the moment within a frame. The mask is written again before each
        // use.
        (FaultKind::SwitchBrownOut, None, End::Done),
        (restarted, None, End::Done),
        (endless, None, End::Note("taxel 1 is stuck")),
        (FaultKind::LostDatagrams, some_datagrams, End::Gap(Stream::Wrench)),
        (FaultKind::LostDatagrams, None, End::Silence("the force sensor")),
        (late, some_datagrams, End::Gap(Stream::Wrench)),
        (FaultKind::DoubledDatagrams, None, End::Done),
        (
            FaultKind::ReorderedDatagrams,
            some_datagrams,
            End::Gap(Stream::Wrench),
        ),
        (FaultKind::ConnectionReset, None, End::Stop("robot")),
        (FaultKind::RobotError { code: 31 }, None, End::Stop("robot")),
        (FaultKind::UnansweredRequests, None, End::Silence("the robot")),
        (FaultKind::SaturatedForce, None, End::Stop("saturation")),
    ];
    // Only a few at a time, because each setup runs in real time.
    for few in table.chunks(3) {
        std::thread::scope(|scope| {
            for (what, lasts, end) in few {
                scope.spawn(move || check(*what, *lasts, end));
            }
        });
    }
}

/// Time from the beginning of a press to its fault, s.
const FAULT_AFTER_S: f64 = 0.8;
/// Longest silence of the device that a fault makes silent, s.
const SILENCE_S: f64 = 0.8;
/// How long the gel is held, s. A press takes longer than fault and silence together, and even
/// longer on a busy machine.
const HOLD_S: f64 = 2.2;

/// The settings for a fault. Only the device that falls silent has the short limit [`SILENCE_S`].
fn settings_for(end: &End) -> PressSettings {
    let mut settings = press_settings();
    match end {
        End::Silence("the tactile sensor") => settings.tactile_silence_s = SILENCE_S,
        End::Silence("the force sensor") => settings.force_silence_s = SILENCE_S,
        End::Silence(_) => settings.robot_silence_s = SILENCE_S,
        _ => {}
    }
    settings
}

fn check(what: FaultKind, lasts: Option<Moment>, end: &End) {
    let folder = TempDir::new().unwrap();
    let (devices, mut bench) = bench();
    if what == FaultKind::UnansweredRequests {
        bench.arm.set_answer_within(Duration::from_secs(2)); // it does not confirm the stop either
    }
    let mut inject = |_: usize, _: &PressPlan| {
        let begins = Moment::TimeS(devices.workcell().clock().now_s() + FAULT_AFTER_S);
        devices.inject(ScheduledFault { what, begins, lasts }).unwrap();
    };
    let interrupt = AtomicBool::new(false);
    let runner = Runner::new(settings_for(end), LIMITS, description(Provenance::Emulated)).unwrap();
    let summary = runner
        .run(
            &mut bench,
            &held_plans(1, HOLD_S),
            folder.path(),
            &interrupt,
            &mut inject,
        )
        .unwrap();
    let (events, frames) = log(folder.path());
    let cause = summary.stopped.as_ref().map(ToString::to_string);
    println!(
        "{what:?} {lasts:?}: {cause:?}, {:?} periods",
        summary.stop_latency_periods
    );
    assert_eq!(summary.lost_unmarked, 0, "{what:?}: {summary:?}");
    assert_eq!(summary.frames, frames, "{what:?}");
    let cause = cause.as_deref();
    match end {
        End::Done => assert_eq!(cause, None, "{what:?}"),
        End::Gap(stream) => {
            assert_eq!(cause, None, "{what:?}");
            assert!(gaps(&events, *stream) > 0, "{what:?}: {events:?}");
        }
        End::Note(words) => {
            assert_eq!(cause, None, "{what:?}");
            let is_there = |event: &Event| matches!(event, Event::Note { text } if text.contains(*words));
            assert!(events.iter().any(is_there), "{what:?}: {events:?}");
        }
        End::Stop(words) | End::Silence(words) => {
            assert!(
                cause.is_some_and(|cause| cause.contains(words)),
                "{what:?}: {cause:?}"
            );
            assert!(events.iter().any(|event| matches!(event, Event::Stopped { .. })));
            assert_eq!(summary.presses_done, 0, "{what:?}");
        }
    }
}

/// An operator who always gives the same answer.
struct Nobody {
    answer: Mounting,
    asked: usize,
}

impl Operator for Nobody {
    fn mount(&mut self, _: &str) -> Mounting {
        self.asked += 1;
        self.answer
    }

    fn begin(&mut self, _: usize, _: &PressPlan) {
        panic!("nothing is pressed with an indenter that nobody mounted");
    }
}

#[test]
fn without_an_indenter_nothing_moves() {
    let folder = TempDir::new().unwrap();
    let (devices, mut bench) = bench();
    let height_mm = devices.workcell().now().tool.position_mm.z;
    let mut run = |answer, interrupt: bool| {
        let mut nobody = Nobody { answer, asked: 0 };
        let interrupt = AtomicBool::new(interrupt);
        let out = folder.path();
        let summary = runner().run(&mut bench, &plans(1), out, &interrupt, &mut nobody);
        (summary.unwrap(), nobody.asked)
    };
    let (refused, asked) = run(Mounting::Refused, false);
    assert_eq!((refused.stopped, asked), (Some(Cause::Operator), 1));
    let (interrupted, _) = run(Mounting::Waiting, true);
    assert_eq!(interrupted.stopped, Some(Cause::Operator));
    // Events that happen meanwhile are heard.
    devices
        .inject(ScheduledFault {
            what: FaultKind::RobotError { code: 31 },
            begins: Moment::Count(0),
            lasts: None,
        })
        .unwrap();
    let (failed, asked) = run(Mounting::Waiting, false);
    assert_eq!(failed.stopped, Some(Cause::RobotInError));
    assert!(
        asked >= 1 && failed.remarks.join(" ").contains("31"),
        "{failed:?}"
    );
    assert!((devices.workcell().now().tool.position_mm.z - height_mm).abs() < 0.01);
    assert!(!folder.path().join("press-0001.mcap").exists());
}

#[test]
fn an_indenter_that_may_touch_is_not_tared_away() {
    let folder = TempDir::new().unwrap();
    let (_devices, mut bench) = bench();
    // An earlier run has left the indenter in the gel.
    let mut pose = bench.arm.pose().unwrap();
    while pose.position_mm.z > 99.6 {
        pose.position_mm.z -= 0.05;
        bench.arm.servo(&pose).unwrap();
    }
    std::thread::sleep(Duration::from_millis(200));
    let summary = run(&mut bench, 1, folder.path());
    let cause = summary.stopped.unwrap().to_string();
    assert!(cause.contains("raise it"), "{cause}");
    assert_eq!(summary.presses_done, 0);
}
