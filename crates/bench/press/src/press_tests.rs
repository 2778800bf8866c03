#![allow(clippy::unwrap_used)]
use glam::{DQuat, DVec3};
use tempfile::TempDir;
use twintac_log::{Body, Description, LogReader, Recorder};
use twintac_recording::Provenance;
use twintac_rig::{RigError, Stamp, WrenchSample};

use super::*;
use crate::settings::example;

const PERIOD_S: f64 = 0.008;
const SENSOR: SensorLimits = SensorLimits {
    force_n: 20.0,
    depth_mm: 4.0,
};

/// An arm that is always at its commanded pose, on a gel of 1 N/mm, without noise.
#[derive(Debug)]
struct Fake {
    poses: Vec<TcpPose>,
    stops: usize,
    /// How long a response has been missing, s.
    missing_s: f64,
}

impl Arm for Fake {
    fn servo(&mut self, pose: &TcpPose) -> Result<(), RigError> {
        self.poses.push(*pose);
        Ok(())
    }

    fn hear(&mut self) -> Result<f64, RigError> {
        Ok(self.missing_s)
    }

    fn stop(&mut self) -> Result<(), RigError> {
        self.stops += 1;
        Ok(())
    }

    fn error(&mut self) -> Option<String> {
        None
    }
}

impl Fake {
    fn at(&self) -> TcpPose {
        self.poses.last().copied().unwrap_or_else(above)
    }

    fn depth_mm(&self) -> f64 {
        100.0 - self.at().position_mm.z
    }
}

fn above() -> TcpPose {
    TcpPose {
        position_mm: DVec3::new(200.0, 0.0, 103.0),
        roll_pitch_yaw_rad: DVec3::new(std::f64::consts::PI, 0.0, 0.0),
    }
}

fn plan(depth_mm: f64) -> PressPlan {
    PressPlan {
        name: "ball#000".to_owned(),
        indenter: "ball".to_owned(),
        x_mm: 1.0,
        y_mm: -1.0,
        rotation: DQuat::IDENTITY,
        clearance_mm: 0.5,
        depth_mm,
        speed_mm_per_s: 5.0,
        hold_s: 0.1,
    }
}

/// A press, period by period, in its own time.
struct Script {
    folder: TempDir,
    settings: PressSettings,
    plan: PressPlan,
    stiffness_n_per_mm: f64,
    /// Whether the arm answers poses below the surface.
    is_answered: bool,
}

struct Outcome {
    cause: Option<Cause>,
    /// Latency of the stop, s.
    latency_s: Option<f64>,
    /// Periods from the period of the cause to that of the stop command.
    periods_to_stop: usize,
    arm: Fake,
    events: Vec<Event>,
    deepest_mm: f64,
}

impl Script {
    fn new(depth_mm: f64) -> Self {
        Self {
            folder: TempDir::new().unwrap(),
            settings: PressSettings {
                force_silence_s: 0.1,
                robot_silence_s: 0.1,
                tactile_silence_s: 0.1,
                ..example()
            },
            plan: plan(depth_mm),
            stiffness_n_per_mm: 1.0,
            is_answered: true,
        }
    }

    /// Runs the press. `say` changes what is heard, given the time and the depth.
    fn run(&self, mut say: impl FnMut(f64, f64, &mut Vec<Heard>) -> bool) -> Outcome {
        let path = self.folder.path().join("press.mcap");
        let recorder = Recorder::create(&path, &description()).unwrap();
        let mut journal = Journal::new(recorder.sender(), 0.0, 0.02, 0.05);
        let start = Start {
            now_s: 0.0,
            pose: above(),
            force_n: DVec3::ZERO,
        };
        let mut press = Press::new(
            &self.settings,
            &SENSOR,
            &self.plan,
            &mut journal,
            start,
            Wrench::ZERO,
        )
        .unwrap();
        let mut arm = Fake {
            poses: Vec::new(),
            stops: 0,
            missing_s: 0.0,
        };
        let (mut now_s, mut deepest_mm) = (0.0, f64::NEG_INFINITY);
        let mut periods_to_stop = 0;
        loop {
            now_s += PERIOD_S;
            assert!(now_s < 60.0, "it ends");
            let depth_mm = arm.depth_mm();
            deepest_mm = depth_mm.max(deepest_mm);
            if !self.is_answered && deepest_mm > 0.0 {
                arm.missing_s += PERIOD_S;
            }
            let mut heard = heard(now_s, self.stiffness_n_per_mm * depth_mm.max(0.0), &arm.at());
            let is_interrupted = say(now_s, depth_mm, &mut heard);
            let is_fresh = press.cause().is_none();
            let n_poses = arm.poses.len();
            let standing = press
                .period(now_s, heard.into_iter(), is_interrupted, &mut arm)
                .unwrap();
            if is_fresh && press.cause().is_some() {
                assert_eq!(arm.poses.len(), n_poses, "the period of a cause sends no pose");
            }
            if standing != Standing::Going {
                break;
            }
            periods_to_stop += usize::from(press.cause().is_some());
        }
        let (cause, latency_s) = (press.cause().cloned(), press.stop_latency_s);
        journal.end(now_s).unwrap();
        recorder.finish().unwrap();
        let messages = LogReader::open(&path).unwrap().map(Result::unwrap);
        let events = messages.filter_map(|message| match message.body {
            Body::Event(event) => Some(event),
            _ => None,
        });
        Outcome {
            cause,
            latency_s,
            periods_to_stop,
            arm,
            events: events.collect(),
            deepest_mm,
        }
    }
}

fn description() -> Description {
    Description {
        sensor: "test".to_owned(),
        sensor_toml: String::new(),
        provenance: Provenance::Emulated,
        taxels: Vec::new(),
        transfer: None,
        base_from_gel: example().placement.base_from_gel,
        tool_from_indenter: example().placement.tool_from_indenter,
        force_axis: DVec3::Z,
        start_unix_ns: 0,
        versions: std::collections::BTreeMap::new(),
    }
}

fn heard(now_s: f64, force_n: f64, pose: &TcpPose) -> Vec<Heard> {
    let wrench = |ago_s: f64| {
        let stamp = Stamp {
            bench_s: now_s - ago_s,
            source_s: None,
        };
        Heard {
            bench_s: now_s - ago_s,
            event: StreamEvent::Wrench(WrenchSample {
                stamp,
                wrench: Wrench {
                    force_n: DVec3::NEG_Z * force_n,
                    torque_n_mm: DVec3::ZERO,
                },
                sequence: None,
                status: 0,
                lost_before: 0,
            }),
        }
    };
    let frame = twintac_log::TactileFrame {
        triggered_us: 0,
        taxels: Vec::new(),
    };
    vec![
        wrench(0.003),
        wrench(0.001),
        Heard {
            bench_s: now_s,
            event: StreamEvent::Robot {
                pose: *pose,
                in_error: false,
            },
        },
        Heard {
            bench_s: now_s,
            event: StreamEvent::Frame(frame),
        },
    ]
}

fn stopped_by_limit(outcome: &Outcome, name: &str) -> bool {
    matches!(&outcome.cause, Some(Cause::LimitExceeded { limit, .. }) if *limit == name)
}

#[test]
fn a_force_beyond_the_limit_stops_in_the_same_period_and_goes_back() {
    let mut script = Script::new(2.0);
    script.settings.limits.force_n = 1.0;
    let outcome = script.run(|_, _, _| false);
    assert!(stopped_by_limit(&outcome, "force"), "{:?}", outcome.cause);
    assert!(outcome.latency_s.unwrap() <= PERIOD_S);
    assert!(
        outcome.deepest_mm <= 1.0 + 5.0 * PERIOD_S + 1e-9,
        "one step beyond the limit at most"
    );
    assert!(outcome.arm.depth_mm() < 0.0, "it went back");
    assert_eq!(outcome.arm.stops, 1);
    assert!(
        outcome
            .events
            .iter()
            .any(|event| matches!(event, Event::Stopped { .. }))
    );
}

#[test]
fn a_depth_beyond_the_limit_never_goes_out() {
    let mut script = Script::new(2.0);
    script.settings.limits.depth_mm = 1.0;
    let outcome = script.run(|_, _, _| false);
    assert!(stopped_by_limit(&outcome, "goal's depth"), "{:?}", outcome.cause);
    assert!(outcome.deepest_mm <= 1.0);
    assert_eq!(outcome.latency_s, Some(0.0));
}

#[test]
fn the_press_goes_as_deep_as_planned_below_first_touch() {
    let outcome = Script::new(1.5).run(|_, _, _| false);
    assert_eq!(outcome.cause, None);
    let note = outcome.events.iter().find_map(|event| match event {
        Event::Note { text } => Some(text.as_str()),
        _ => None,
    });
    assert!(note.unwrap().starts_with("first touch"), "{:?}", outcome.events);
    // A touch of 0.1 N is 0.1 mm below the surface, and is detected one window later.
    let touch_mm = outcome.deepest_mm - 1.5;
    assert!((0.1..0.2).contains(&touch_mm), "{touch_mm}");
    let kinds: Vec<bool> = outcome
        .events
        .iter()
        .filter_map(|event| match event {
            Event::PressBegun { .. } => Some(true),
            Event::PressEnded { .. } => Some(false),
            _ => None,
        })
        .collect();
    assert_eq!(kinds, [true, false]);
}

#[test]
fn force_before_the_approach_is_no_first_touch() {
    // The gel is higher than described: there is a force above the described surface.
    let outcome = Script::new(1.5).run(|now_s, depth_mm, heard| {
        if depth_mm > -2.0 {
            heard.extend(self::heard(now_s, 1.0, &above()).into_iter().take(2));
            heard.drain(..2);
        }
        false
    });
    let cause = outcome.cause.unwrap().to_string();
    assert!(cause.contains("before the approach"), "{cause}");
    assert!(outcome.deepest_mm < 0.0);
}

#[test]
fn a_gel_that_is_not_there_is_no_place_to_go_on_to() {
    let mut script = Script::new(1.5);
    script.stiffness_n_per_mm = 0.0;
    let outcome = script.run(|_, _, _| false);
    assert!(outcome.cause.unwrap().to_string().contains("no touch"));
    assert!(outcome.deepest_mm <= script.settings.search_mm + 1e-9);
}

#[test]
fn silence_errors_losses_and_people_stop_a_press() {
    let quiet =
        |heard: &mut Vec<Heard>, keep: fn(&StreamEvent) -> bool| heard.retain(|heard| keep(&heard.event));
    let late = |depth_mm: f64| depth_mm > 0.5;
    let force = Script::new(2.0).run(|_, depth_mm, heard| {
        if late(depth_mm) {
            quiet(heard, |event| !matches!(event, StreamEvent::Wrench(_)));
        }
        false
    });
    assert!(matches!(force.cause, Some(Cause::StreamSilent { .. })));
    assert!(force.arm.depth_mm() > 0.0, "blind, it stays where it is");
    assert_eq!(
        (force.periods_to_stop, force.arm.stops),
        (0, 1),
        "and is stopped at once"
    );
    let taxels = Script::new(2.0).run(|_, depth_mm, heard| {
        if late(depth_mm) {
            quiet(heard, |event| !matches!(event, StreamEvent::Frame(_)));
        }
        false
    });
    assert!(taxels.cause.unwrap().to_string().contains("tactile"));
    assert!(
        taxels
            .events
            .iter()
            .any(|event| matches!(event, Event::Gap { .. }))
    );
    let robot = Script::new(2.0).run(|_, depth_mm, heard| {
        for heard in heard.iter_mut().filter(|_| late(depth_mm)) {
            if let StreamEvent::Robot { in_error, .. } = &mut heard.event {
                *in_error = true;
            }
        }
        false
    });
    assert_eq!(robot.cause, Some(Cause::RobotInError));
    assert!(robot.arm.depth_mm() > 0.0, "no pose for a robot in error");
    let lost = Script::new(2.0).run(|_, depth_mm, heard| {
        for heard in heard.iter_mut().filter(|_| late(depth_mm)) {
            if let StreamEvent::Wrench(sample) = &mut heard.event {
                sample.lost_before = 1000;
            }
        }
        false
    });
    assert!(matches!(lost.cause, Some(Cause::DataLost { records: 1000, .. })));
    let mut unanswered = Script::new(2.0);
    unanswered.is_answered = false;
    let unanswered = unanswered.run(|_, _, _| false);
    let cause = unanswered.cause.unwrap().to_string();
    assert!(
        cause.starts_with("nothing from the robot's answers for 0.1"),
        "{cause}"
    );
    assert!(unanswered.latency_s.unwrap() <= PERIOD_S);
    assert!(
        unanswered.arm.depth_mm() < 0.0,
        "its reports say that it goes back"
    );
    let person = Script::new(2.0).run(|_, depth_mm, _| late(depth_mm));
    assert_eq!(person.cause, Some(Cause::Operator));
    assert!(person.arm.depth_mm() < 0.0, "it went back");
}
