//! A supervised press on the emulated robot and force sensor, in virtual time and without sockets:
//! each fault, and the cause that it gives.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use glam::DVec3;
use twintac_emulate::force::{ForceSensor, ForceSettings};
use twintac_emulate::robot::{Controller, RobotSettings};
use twintac_emulate::{FaultKind, Hertz, LabClock, Moment, ScheduledFault, Workcell};
use twintac_rig::netft::{
    Arrival, Command as ForceCommand, Health, Request as ForceRequest, SequenceTracker, decode_records,
};
use twintac_rig::xarm::{
    Command, Incoming, Mode, MoveTo, PROTOCOL, Report, ReportPort, Request, Response, SetState,
};
use twintac_rig::{
    Cause, Decision, Limits, Observation, Retreat, SensorLimits, Setup, Start, StreamId, Supervisor, TcpPose,
    Workspace,
};

const PERIOD_S: f64 = 0.004;
const PERIODS: u64 = 250;

fn at(height_mm: f64) -> TcpPose {
    TcpPose {
        position_mm: DVec3::new(200.0, 0.0, 100.0 + height_mm),
        roll_pitch_yaw_rad: DVec3::new(3.0, 0.0, 0.0),
    }
}

/// Result of a press.
#[derive(Clone, Debug, PartialEq)]
struct Outcome {
    cause: Option<Cause>,
    /// The servo period in which it stopped.
    period: u64,
    most_n: f64,
    last_height_mm: f64,
}

/// The emulated devices and the state of their client.
struct Rig {
    clock: LabClock,
    workcell: Workcell,
    controller: Controller,
    force: ForceSensor,
    tracker: SequenceTracker,
    supervisor: Supervisor,
    transaction: u16,
    most_n: f64,
}

impl Rig {
    fn new(faults: &[ScheduledFault], force_limit_n: f64) -> Self {
        let clock = LabClock::virtual_time();
        let settings = RobotSettings {
            first_pose: at(1.0),
            ..RobotSettings::default()
        };
        let workcell = Workcell::new(clock.clone(), Hertz::default(), at(1.0), settings.arm);
        let setup = Setup {
            limits: Limits {
                force_n: force_limit_n,
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
            approach: DVec3::NEG_Z,
            servo_period_s: PERIOD_S,
            force_silence_s: 0.03,
            robot_silence_s: 0.05,
            retreat: Retreat {
                distance_mm: 2.0,
                speed_mm_per_s: 25.0,
                force_noise_n: 0.5,
            },
        };
        let sensor = SensorLimits {
            force_n: 20.0,
            depth_mm: 4.0,
        };
        let start = Start {
            now_s: 0.0,
            pose: at(1.0),
            force_n: DVec3::ZERO,
        };
        let mut force = ForceSensor::new(workcell.clone(), ForceSettings::default(), faults).unwrap();
        let (command, samples) = (ForceCommand::StartRealTime, 0);
        force.hear(&ForceRequest { command, samples }.encode());
        let mut rig = Self {
            controller: Controller::new(workcell.clone(), settings, faults).unwrap(),
            force,
            tracker: SequenceTracker::default(),
            supervisor: Supervisor::new(setup, &sensor, start).unwrap(),
            transaction: 0,
            most_n: 0.0,
            workcell,
            clock,
        };
        let (mode, detection) = (Mode::Servo, Some(0));
        for command in [
            Command::MotionEnable {
                axis: Command::ALL_AXES,
                on: true,
            },
            Command::SetMode { mode, detection },
            Command::SetState(SetState::Motion),
        ] {
            rig.call(command).unwrap();
        }
        rig
    }

    fn call(&mut self, command: Command) -> Option<Response> {
        self.transaction += 1;
        let request = Request {
            transaction: self.transaction,
            protocol: PROTOCOL,
            command,
        };
        let frame = self.controller.respond(&request.encode())?;
        match Incoming::decode(&frame).unwrap() {
            Incoming::Response(response) => Some(response),
            feedback @ Incoming::Feedback(_) => panic!("{feedback:?}"),
        }
    }

    fn hear_force(&mut self, now_s: f64) {
        for outgoing in self.force.due() {
            for record in decode_records(&outgoing.datagram).unwrap() {
                let event = match self.tracker.track(&record).arrival {
                    _ if record.status.health() == Health::Error => Observation::DeviceError {
                        stream: StreamId::FORCE,
                        problem: record.status.to_string(),
                    },
                    Arrival::AfterGap { lost } => Observation::DataLost {
                        stream: StreamId::FORCE,
                        records: lost.into(),
                    },
                    Arrival::InOrder => {
                        let force_n = self.force.configuration().wrench(record.counts).force_n;
                        self.most_n = self.most_n.max(force_n.length());
                        Observation::Force(force_n)
                    }
                    _ => continue,
                };
                self.supervisor.observe(now_s, event);
            }
        }
    }

    fn hear_robot(&mut self, now_s: f64) {
        self.controller.look();
        let frame = self.controller.report_frame(ReportPort::Rich);
        let report = Report::decode(ReportPort::Rich, &frame).unwrap();
        let event = Observation::Robot {
            pose: report.pose,
            in_error: report.status.unwrap().error != 0,
        };
        self.supervisor.observe(now_s, event);
    }

    fn send(&mut self, now_s: f64, pose: TcpPose) {
        let to = MoveTo {
            pose,
            speed_mm_per_s: 0.0,
            acceleration_mm_per_s2: 0.0,
        };
        let in_tool_frame = false;
        let response = self.call(Command::ServoCartesian { to, in_tool_frame });
        if response.is_none_or(|response| response.state.0 != 0) {
            let problem = "no good answer".to_owned();
            let stream = StreamId::ROBOT;
            self.supervisor
                .observe(now_s, Observation::DeviceError { stream, problem });
        }
    }

    /// Presses 2 mm deep at 5 mm/s, and then holds.
    fn press(mut self) -> Outcome {
        let mut stopped = None;
        for period in 1..=PERIODS {
            self.clock.wait_s(PERIOD_S);
            let now_s = self.clock.now_s();
            self.hear_force(now_s);
            self.hear_robot(now_s);
            let goal = at((1.0 - 5.0 * PERIOD_S * period as f64).max(-2.0));
            match self.supervisor.decide(now_s, &goal) {
                Decision::Go(pose) | Decision::Retreat(pose) => self.send(now_s, pose),
                Decision::Stop => {}
            }
            if self.supervisor.cause().is_some() {
                stopped = stopped.or(Some(period));
            }
        }
        Outcome {
            cause: self.supervisor.cause().cloned(),
            period: stopped.unwrap_or(PERIODS),
            most_n: self.most_n,
            last_height_mm: self.workcell.now().tool.position_mm.z - 100.0,
        }
    }
}

/// A press with a fault from 0.6 s on, when the goal has just reached its depth.
fn with(what: FaultKind, lasts: Option<Moment>) -> Outcome {
    let begins = Moment::TimeS(0.6);
    let press = || Rig::new(&[ScheduledFault { what, begins, lasts }], 10.0).press();
    let outcome = press();
    assert_eq!(outcome, press(), "repeats itself");
    outcome
}

fn cause(what: FaultKind, lasts: Option<Moment>) -> Cause {
    let outcome = with(what, lasts);
    assert!((150..165).contains(&outcome.period), "{outcome:?}");
    outcome.cause.unwrap()
}

#[test]
fn a_press_without_faults_reaches_its_depth_and_its_force() {
    let outcome = Rig::new(&[], 10.0).press();
    assert_eq!(outcome.cause, None);
    assert!((outcome.last_height_mm + 2.0).abs() < 0.01, "{outcome:?}");
    let expected_n = Hertz::default().force_n(2.0);
    assert!(
        (expected_n..expected_n + 0.3).contains(&outcome.most_n),
        "{outcome:?}"
    );
}

#[test]
fn a_force_beyond_the_limit_stops_the_press_and_takes_the_robot_back() {
    let limit_n = 0.6;
    let outcome = Rig::new(&[], limit_n).press();
    assert!(
        matches!(outcome.cause, Some(Cause::LimitExceeded { limit: "force", .. })),
        "{outcome:?}"
    );
    assert!(outcome.most_n < limit_n + 0.3, "{outcome:?}");
    assert!(outcome.last_height_mm > 0.0, "it went back: {outcome:?}");
}

#[test]
fn each_fault_of_the_force_sensor_has_its_name() {
    let ten = Some(Moment::Count(10));
    assert!(matches!(
        cause(FaultKind::LostDatagrams, ten),
        Cause::DataLost { records: 10, .. }
    ));
    assert!(matches!(
        cause(FaultKind::LostDatagrams, None),
        Cause::StreamSilent { .. }
    ));
    assert!(matches!(
        cause(FaultKind::ReorderedDatagrams, ten),
        Cause::DataLost { records: 1, .. }
    ));
    let late = FaultKind::LateDatagrams { by_s: 0.05 };
    assert!(matches!(cause(late, None), Cause::StreamSilent { .. }));
    match cause(FaultKind::SaturatedForce, ten) {
        Cause::DeviceError { problem, .. } => assert!(problem.contains("saturation"), "{problem}"),
        other => panic!("{other}"),
    }
    assert_eq!(with(FaultKind::DoubledDatagrams, None).cause, None, "harmless");
}

#[test]
fn each_fault_of_the_robot_has_its_name() {
    assert_eq!(
        cause(FaultKind::RobotError { code: 31 }, None),
        Cause::RobotInError
    );
    assert!(matches!(
        cause(FaultKind::UnansweredRequests, None),
        Cause::DeviceError { .. }
    ));
    let outcome = with(FaultKind::RobotError { code: 31 }, None);
    assert!(
        outcome.last_height_mm < 0.0,
        "with its motors' error it stays where it is: {outcome:?}"
    );
}
