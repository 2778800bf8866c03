use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::safety::{Limits, Retreat, Workspace};

const SENSOR: SensorLimits = SensorLimits {
    force_n: 20.0,
    depth_mm: 4.0,
};
const PERIOD_S: f64 = 0.004;

fn setup() -> Setup {
    Setup {
        limits: Limits {
            force_n: 10.0,
            depth_mm: 3.0,
            workspace: Workspace {
                min_mm: DVec3::new(150.0, -50.0, 90.0),
                max_mm: DVec3::new(250.0, 50.0, 150.0),
            },
            step_mm: 1.0,
            turn_step_rad: 0.1,
            speed_mm_per_s: 50.0,
        },
        surface_mm: DVec3::new(200.0, 0.0, 100.0),
        approach: DVec3::new(0.0, 0.0, -2.0),
        servo_period_s: PERIOD_S,
        force_silence_s: 0.02,
        robot_silence_s: 0.1,
        retreat: Retreat {
            distance_mm: 2.0,
            speed_mm_per_s: 25.0,
            force_noise_n: 0.2,
        },
    }
}

fn at(height_mm: f64) -> TcpPose {
    TcpPose {
        position_mm: DVec3::new(200.0, 0.0, 100.0 + height_mm),
        roll_pitch_yaw_rad: DVec3::new(std::f64::consts::PI, 0.0, 0.0),
    }
}

fn start() -> Start {
    Start {
        now_s: 0.0,
        pose: at(1.0),
        force_n: DVec3::ZERO,
    }
}

fn supervisor() -> Supervisor {
    Supervisor::new(setup(), &SENSOR, start()).unwrap()
}

/// A press in which the robot follows at once. Both sensors report in each period.
struct Bench {
    supervisor: Supervisor,
    now_s: f64,
    height_mm: f64,
}

impl Bench {
    fn new() -> Self {
        Self {
            supervisor: supervisor(),
            now_s: 0.0,
            height_mm: 1.0,
        }
    }

    fn period(&mut self, force_n: f64, goal_height_mm: f64) -> Decision {
        self.now_s += PERIOD_S;
        let robot = Observation::Robot {
            pose: at(self.height_mm),
            in_error: false,
        };
        self.supervisor
            .observe(self.now_s, Observation::Force(DVec3::Z * force_n));
        self.supervisor.observe(self.now_s, robot);
        let decision = self.supervisor.decide(self.now_s, &at(goal_height_mm));
        if let Decision::Go(pose) | Decision::Retreat(pose) = decision {
            self.height_mm = pose.position_mm.z - 100.0;
        }
        decision
    }
}

#[test]
fn a_press_within_its_limits_goes_through() {
    let mut bench = Bench::new();
    for step in 1..=200 {
        let height_mm = 1.0 - 0.02 * f64::from(step);
        let force_n = (-3.0 * height_mm).max(0.0);
        assert_eq!(bench.period(force_n, height_mm), Decision::Go(at(height_mm)));
    }
    assert_eq!(bench.supervisor.cause(), None);
}

#[test]
fn too_much_force_stops_in_the_same_call_and_then_goes_straight_up() {
    let mut bench = Bench::new();
    assert_eq!(bench.period(9.9, 0.9), Decision::Go(at(0.9)));
    assert_eq!(bench.period(10.1, 0.8), Decision::Stop);
    let words = bench.supervisor.cause().unwrap().to_string();
    assert_eq!(words, "force is 10.1 N, the limit is 10 N");
    // The force still rises, so the retreat waits. Then the robot moves up by 0.1 mm a period, for
    // 2 mm.
    assert_eq!(bench.period(11.0, 0.8), Decision::Stop);
    for step in 1..=20 {
        let Decision::Retreat(pose) = bench.period(11.0 - 0.5 * f64::from(step), 0.8) else {
            panic!("step {step}");
        };
        assert!(
            pose.distance_mm(&at(0.9 + 0.1 * f64::from(step))) < 1e-9,
            "{pose:?}"
        );
    }
    for _ in 0..10 {
        assert_eq!(bench.period(0.0, 0.8), Decision::Stop);
    }
}

#[test]
fn a_retreat_does_not_fall_back_to_an_old_report() {
    let mut bench = Bench::new();
    for step in 1..=9 {
        let robot = Observation::Robot {
            pose: at(1.0), // an old report: the robot has gone up since
            in_error: false,
        };
        bench.now_s += PERIOD_S;
        bench
            .supervisor
            .observe(bench.now_s, Observation::Force(DVec3::ZERO));
        bench.supervisor.observe(bench.now_s, robot);
        let goal = at(1.0 + 0.1 * f64::from(step));
        assert_eq!(bench.supervisor.decide(bench.now_s, &goal), Decision::Go(goal));
    }
    bench.supervisor.observe(bench.now_s, Observation::OperatorStop);
    assert_eq!(bench.supervisor.decide(bench.now_s, &at(1.9)), Decision::Stop);
    let Decision::Retreat(pose) = bench.supervisor.decide(bench.now_s, &at(1.9)) else {
        panic!("nothing is in its way");
    };
    assert!((pose.position_mm.z - 102.0).abs() < 1e-9, "{pose:?}");
}

#[test]
fn a_retreat_ends_for_good_when_the_force_rises() {
    let mut bench = Bench::new();
    bench.period(12.0, 0.9);
    assert!(matches!(bench.period(12.0, 0.9), Decision::Retreat(_)));
    assert!(matches!(bench.period(8.0, 0.9), Decision::Retreat(_)));
    assert!(
        matches!(bench.period(8.1, 0.9), Decision::Retreat(_)),
        "within the noise"
    );
    assert_eq!(bench.period(8.3, 0.9), Decision::Stop);
    assert_eq!(bench.period(2.0, 0.9), Decision::Stop);
}

#[test]
fn goals_beyond_a_limit_stop() {
    let sideways = |x_mm: f64| TcpPose {
        position_mm: DVec3::new(200.0 + x_mm, 0.0, 101.0),
        ..at(1.0)
    };
    let turned = TcpPose {
        roll_pitch_yaw_rad: DVec3::new(3.0, 0.0, 0.0),
        ..at(1.0)
    };
    for (goal, words) in [
        (sideways(1.5), "goal's step is 1.5 mm, the limit is 1 mm"),
        (sideways(0.5), "goal's speed is 125 mm/s, the limit is 50 mm/s"),
        (
            sideways(-60.0),
            "goal (140.00, 0.00, 101.00) mm is outside the workspace",
        ),
        (at(-3.5), "goal's depth is 3.5 mm, the limit is 3 mm"),
        (turned, "goal's turn is 0.14159265"),
        (
            at(f64::NAN),
            "goal (200.00, 0.00, NaN) mm is outside the workspace",
        ),
    ] {
        let mut supervisor = supervisor();
        assert_eq!(supervisor.decide(PERIOD_S, &goal), Decision::Stop);
        let found = supervisor.cause().unwrap().to_string();
        assert!(found.starts_with(words), "{found}");
        assert_eq!(
            supervisor.decide(PERIOD_S, &at(1.0)),
            Decision::Stop,
            "stays stopped"
        );
    }
}

#[test]
fn each_stream_has_a_watchdog() {
    for (silent, after_s) in [
        ("the force sensor", 0.02),
        ("the robot", 0.1),
        ("the taxels", 0.05),
    ] {
        let mut supervisor = supervisor();
        let taxels = supervisor.watch("the taxels", 0.05, 0.0);
        let stopped_s = (1..100).map(|period| f64::from(period) * 0.004).find(|&now_s| {
            let robot = Observation::Robot {
                pose: at(1.0),
                in_error: false,
            };
            for (stream, event) in [
                ("the force sensor", Observation::Force(DVec3::ZERO)),
                ("the robot", robot),
                ("the taxels", Observation::Heard(taxels)),
            ] {
                if stream != silent {
                    supervisor.observe(now_s, event);
                }
            }
            supervisor.decide(now_s, &at(1.0)) == Decision::Stop
        });
        let late_s = stopped_s.unwrap() - after_s;
        assert!(
            (0.0..=0.004 + 1e-9).contains(&late_s),
            "{silent}: {late_s} s late"
        );
        let words = supervisor.cause().unwrap().to_string();
        assert!(
            words.starts_with(&format!("nothing from {silent} for ")),
            "{words}"
        );
    }
}

#[test]
fn without_force_sensor_or_with_an_error_there_is_no_retreat() {
    let dead = Observation::DeviceError {
        stream: StreamId::FORCE,
        problem: "gauge broken".into(),
    };
    let in_error = Observation::Robot {
        pose: at(1.0),
        in_error: true,
    };
    for (event, words) in [
        (dead, "the force sensor: gauge broken"),
        (in_error, "the robot reports an error"),
    ] {
        let mut supervisor = supervisor();
        assert_eq!(supervisor.observe(0.001, event).unwrap().to_string(), words);
        for period in 1..20 {
            let now_s = f64::from(period) * PERIOD_S;
            supervisor.observe(now_s, Observation::Force(DVec3::ZERO));
            assert_eq!(supervisor.decide(now_s, &at(1.0)), Decision::Stop);
        }
    }
}

#[test]
fn lost_data_and_the_operator_stop() {
    let mut bench = Bench::new();
    let lost = Observation::DataLost {
        stream: StreamId::FORCE,
        records: 3,
    };
    let cause = bench.supervisor.observe(0.001, lost).cloned();
    assert_eq!(cause.unwrap().to_string(), "the force sensor: 3 records lost");
    bench.supervisor.observe(0.001, Observation::OperatorStop);
    assert!(
        matches!(bench.supervisor.cause(), Some(Cause::DataLost { .. })),
        "the first cause stays"
    );
    let mut bench = Bench::new();
    assert_eq!(
        bench.supervisor.observe(0.001, Observation::OperatorStop),
        Some(&Cause::Operator)
    );
    assert_eq!(bench.period(0.0, 1.0), Decision::Stop);
}

#[test]
fn limits_cannot_be_raised_above_the_sensors() {
    let with = |change: fn(&mut Setup)| {
        let mut setup = setup();
        change(&mut setup);
        Supervisor::new(setup, &SENSOR, start()).unwrap_err().to_string()
    };
    assert_eq!(
        with(|setup| setup.limits.force_n = 25.0),
        "the force limit is set to 25 N, but the sensor's description allows 20 N at most"
    );
    assert_eq!(
        with(|setup| setup.limits.depth_mm = 4.5),
        "the depth limit is set to 4.5 mm, but the sensor's description allows 4 mm at most"
    );
    assert!(with(|setup| setup.limits.force_n = f64::NAN).contains("force limit"));
    assert!(with(|setup| setup.limits.step_mm = 0.0).starts_with("safety: `limits.step_mm` is 0"));
    assert!(with(|setup| setup.force_silence_s = f64::INFINITY).contains("force_silence_s"));
    assert!(with(|setup| setup.approach = DVec3::ZERO).contains("approach"));
    assert!(with(|setup| setup.retreat.speed_mm_per_s = 60.0).contains("above the limit of 50 mm/s"));
    assert!(with(|setup| setup.limits.workspace.max_mm.z = 100.5).contains("does not hold"));
    assert!(with(|setup| setup.surface_mm.z = 105.0).contains("a depth of 4.00 mm"));
}

/// Any event. Most of them are harmless.
fn event() -> impl Strategy<Value = Observation> {
    let number = || {
        prop_oneof![
            8 => -1.0..1.0_f64,
            1 => -500.0..500.0_f64,
            1 => Just(f64::NAN),
            1 => Just(f64::INFINITY),
        ]
    };
    let pose = (number(), number(), number()).prop_map(|(x, y, z)| TcpPose {
        position_mm: DVec3::new(200.0 + x, y, 101.0 + z),
        ..at(0.0)
    });
    let stream = prop_oneof![Just(StreamId::FORCE), Just(StreamId::ROBOT)];
    prop_oneof![
        20 => number().prop_map(|force_n| Observation::Force(DVec3::X * force_n)),
        20 => (pose, prop::bool::weighted(0.05)).prop_map(|(pose, in_error)| Observation::Robot { pose, in_error }),
        5 => stream.clone().prop_map(Observation::Heard),
        1 => stream.clone().prop_map(|stream| Observation::DeviceError { stream, problem: "broken".into() }),
        1 => (stream, 1..9_u64).prop_map(|(stream, records)| Observation::DataLost { stream, records }),
        1 => Just(Observation::OperatorStop),
    ]
}

/// What comes next: events and decisions, at times that do not always increase.
fn step() -> impl Strategy<Value = (f64, Result<Observation, f64>)> {
    let elapsed_s =
        prop_oneof![20 => 0.0..0.005_f64, 1 => 0.0..0.2_f64, 1 => Just(f64::NAN), 1 => Just(-1.0)];
    let goal = prop_oneof![8 => -0.2..0.2_f64, 1 => -5.0..5.0_f64, 1 => Just(f64::NAN)];
    (elapsed_s, prop_oneof![event().prop_map(Ok), goal.prop_map(Err)])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    /// For any sequence of events: no pose that breaks a limit is released, a cause stops the press
    /// in the same call, and after a cause no pose goes towards the sensor.
    #[test]
    fn after_a_cause_nothing_goes_forward(steps in prop::collection::vec(step(), 1..120)) {
        let mut supervisor = supervisor();
        let (mut now_s, mut goal_mm) = (0.0, at(1.0).position_mm);
        let (mut measured, mut retreated): (TcpPose, Option<TcpPose>) = (at(1.0), None);
        for (elapsed_s, what) in steps {
            let time_s = now_s + elapsed_s;
            if time_s > now_s {
                now_s = time_s;
            }
            let before = supervisor.cause().cloned();
            match what {
                Ok(event) => {
                    if let Observation::Robot { pose, .. } = &event {
                        measured = *pose;
                    }
                    supervisor.observe(time_s, event);
                }
                Err(up_mm) => {
                    let goal = TcpPose { position_mm: goal_mm + DVec3::Z * up_mm, ..at(0.0) };
                    match supervisor.decide(time_s, &goal) {
                        Decision::Go(pose) => {
                            prop_assert!(supervisor.cause().is_none());
                            prop_assert!(pose == goal && up_mm.abs() <= 1.0);
                            prop_assert!(pose.position_mm.z >= 97.0);
                            goal_mm = pose.position_mm;
                        }
                        Decision::Stop => prop_assert!(supervisor.cause().is_some()),
                        Decision::Retreat(pose) => {
                            prop_assert!(before.is_some(), "the first call of a cause stops");
                            prop_assert!(setup().limits.workspace.contains(pose.position_mm, 0.0));
                            prop_assert!(pose.position_mm.z > measured.position_mm.z.max(goal_mm.z));
                            if let Some(last) = retreated {
                                prop_assert!(pose.position_mm.z > last.position_mm.z);
                                prop_assert_eq!(pose.position_mm.truncate(), last.position_mm.truncate());
                            }
                            retreated = Some(pose);
                        }
                    }
                }
            }
            if before.is_some() {
                // Compared as texts: a cause may hold NaN, which is not equal to itself.
                prop_assert_eq!(supervisor.cause().map(ToString::to_string), before.map(|cause| cause.to_string()));
            }
        }
    }

    /// A cause at any time in a healthy press stops it in the servo period of the cause.
    #[test]
    fn a_stop_takes_no_longer_than_a_servo_period(causing in event(), after in 1..60_u32, later_s in 0.0..PERIOD_S) {
        let mut bench = Bench::new();
        for period in 1..after {
            let height_mm = 1.0 - 0.01 * f64::from(period);
            prop_assert_eq!(bench.period(0.0, height_mm), Decision::Go(at(height_mm)));
        }
        let height_mm = bench.height_mm;
        let cause = bench.supervisor.observe(bench.now_s + later_s, causing).cloned();
        let decision = bench.supervisor.decide(bench.now_s + PERIOD_S, &at(height_mm));
        match cause {
            Some(_) => prop_assert_eq!(decision, Decision::Stop),
            None => prop_assert_eq!(decision, Decision::Go(at(height_mm))),
        }
    }
}
