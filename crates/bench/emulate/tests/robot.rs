//! The client against the emulated robot on the loopback.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::net::TcpStream;
use std::time::Duration;

use glam::DVec3;
use twintac_emulate::robot::{Controller, RobotServer, RobotSettings};
use twintac_emulate::{FaultKind, Hertz, LabClock, Moment, ScheduledFault, Workcell};
use twintac_rig::xarm::{
    Client, Command, ControllerCode, Mode, MotionState, MoveTo, PROTOCOL, Report, ReportPort, ReportReader,
    Request, SetState,
};
use twintac_rig::{RigError, TcpPose};

/// A wait that is longer than any delay of a busy machine.
const LATEST: Duration = Duration::from_secs(60);
/// How long to wait for a report that may not come.
const GLANCE: Duration = Duration::from_millis(20);

fn workcell(clock: &LabClock) -> Workcell {
    let settings = RobotSettings::default();
    Workcell::new(clock.clone(), Hertz::default(), settings.first_pose, settings.arm)
}

fn robot(faults: &[(FaultKind, Moment, Option<Moment>)]) -> RobotServer {
    let faults: Vec<ScheduledFault> = faults
        .iter()
        .map(|(what, begins, lasts)| ScheduledFault {
            what: *what,
            begins: *begins,
            lasts: *lasts,
        })
        .collect();
    robot_on(&LabClock::real(), &faults)
}

fn robot_on(clock: &LabClock, faults: &[ScheduledFault]) -> RobotServer {
    RobotServer::start(workcell(clock), RobotSettings::default(), faults).unwrap()
}

fn client(robot: &RobotServer) -> Client<TcpStream> {
    let mut client = Client::connect(robot.commands()).unwrap();
    client.set_answer_within(LATEST);
    client
}

fn reader(robot: &RobotServer, port: ReportPort) -> ReportReader<TcpStream> {
    ReportReader::new(TcpStream::connect(robot.reports(port)).unwrap(), port)
}

/// The next report of a robot whose clock stands still until somebody waits.
fn next_while_time_passes(clock: &LabClock, reader: &mut ReportReader<TcpStream>) -> Report {
    let mut next = || {
        clock.wait_s(0.1);
        reader.next_report(GLANCE).unwrap()
    };
    (0..LATEST.div_duration_f64(GLANCE) as usize)
        .find_map(|_| next())
        .unwrap()
}

fn lower(pose: &TcpPose, by_mm: f64) -> TcpPose {
    TcpPose {
        position_mm: pose.position_mm - DVec3::Z * by_mm,
        ..*pose
    }
}

fn code_of<T: std::fmt::Debug>(result: Result<T, RigError>) -> ControllerCode {
    match result {
        Err(RigError::Controller { code, .. }) => code,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_robot_that_was_enabled_moves_and_then_follows() {
    let robot = robot(&[]);
    let mut client = client(&robot);
    assert_eq!(client.version().unwrap(), "6,6,XI1200,AC1200,v1.11.0");
    assert_eq!(client.state().unwrap(), MotionState::Stopped);
    let to = |pose| MoveTo {
        pose,
        speed_mm_per_s: 300.0,
        acceleration_mm_per_s2: 2000.0,
    };
    let first = client.pose().unwrap();
    assert!(matches!(
        client.move_to(&to(first), LATEST),
        Err(RigError::Robot { .. })
    ));
    client.enable().unwrap();
    client.move_to(&to(lower(&first, 40.0)), LATEST).unwrap();
    let mut pose = client.begin_servo().unwrap();
    assert!((pose.position_mm.z - 110.0).abs() < 0.02);
    for _ in 0..50 {
        pose = lower(&pose, 0.2);
        client.servo(&pose).unwrap();
    }
    std::thread::sleep(Duration::from_millis(250));
    assert!(client.pose().unwrap().distance_mm(&pose) < 0.02);
    assert_eq!(client.state().unwrap(), MotionState::Ready);
    client.stop().unwrap();
    assert!(client.servo(&pose).is_err());
    client.enable().unwrap();
    let slowly = MoveTo {
        speed_mm_per_s: 0.05, // 200 s
        ..to(lower(&pose, 10.0))
    };
    let (to, time_s) = (slowly, 0.0);
    client.call(Command::MoveLine { to, time_s }).unwrap();
    assert_eq!(client.state().unwrap(), MotionState::Moving);
    client.stop().unwrap();
}

#[test]
fn servo_poses_want_servo_mode_and_small_steps() {
    let robot = robot(&[]);
    let mut client = client(&robot);
    client.enable().unwrap();
    let pose = client.pose().unwrap();
    let servo = |pose: TcpPose| Command::ServoCartesian {
        to: MoveTo {
            pose,
            speed_mm_per_s: 0.0,
            acceleration_mm_per_s2: 0.0,
        },
        in_tool_frame: false,
    };
    let refused = client.call(servo(pose)).unwrap_err().to_string();
    assert!(refused.contains("invalid"), "in position mode: {refused}");
    client.set_mode(Mode::Servo).unwrap();
    assert!(
        matches!(client.call(servo(pose)), Err(RigError::Robot { .. })),
        "before state 0"
    );
    client.set_state(SetState::Motion).unwrap();
    client.call(servo(lower(&pose, 9.9))).unwrap();
    let too_far = client.call(servo(lower(&pose, 20.0)));
    assert_eq!(code_of(too_far), ControllerCode::Error(24));
    // The error is latched: the state cannot be set to motion before the error is cleared, and all
    // other responses report it.
    assert_eq!(
        code_of(client.set_state(SetState::Motion)),
        ControllerCode::Error(24)
    );
    assert_eq!(client.state().unwrap(), MotionState::Stopped);
    client.clean_errors().unwrap();
    assert_eq!(client.errors().unwrap(), None);
    client.set_state(SetState::Motion).unwrap();
    let nowhere = TcpPose {
        position_mm: DVec3::NAN,
        ..pose
    };
    assert_eq!(code_of(client.call(servo(nowhere))), ControllerCode::Warning(12));
    client.clean_errors().unwrap();
    assert_eq!(
        code_of(client.call(servo(lower(&pose, 2000.0)))),
        ControllerCode::Error(40)
    );
}

#[test]
fn a_client_that_is_dropped_in_servo_mode_stops_the_robot() {
    let robot = robot(&[]);
    let mut first = client(&robot);
    first.enable().unwrap();
    first.begin_servo().unwrap();
    let mut second = client(&robot);
    assert_ne!(second.state().unwrap(), MotionState::Stopped);
    drop(first);
    assert_eq!(second.state().unwrap(), MotionState::Stopped);
}

#[test]
fn reports_come_at_their_rates_and_say_what_is() {
    let clock = LabClock::virtual_time();
    let robot = robot_on(&clock, &[]);
    let mut commands = client(&robot);
    commands.enable().unwrap();
    let mut development = reader(&robot, ReportPort::Development);
    // The thread that reports has started, and the clock stands at the time of a report.
    while development.next_report(GLANCE).unwrap().is_none() {
        clock.wait_s(0.01);
    }
    while development.next_report(GLANCE).unwrap().is_some() {}
    let reports = (0..30).map(|_| {
        clock.wait_s(0.005);
        clock.wait_s(0.005);
        development.next_report(LATEST).unwrap().unwrap()
    });
    let last = reports.last().unwrap();
    assert_eq!(
        development.next_report(GLANCE).unwrap(),
        None,
        "none is due in between"
    );
    let mut rich = reader(&robot, ReportPort::Rich);
    assert_eq!((last.state, last.mode), (MotionState::Ready, 0));
    assert!(last.pose.distance_mm(&RobotSettings::default().first_pose) < 1e-4);
    let report = next_while_time_passes(&clock, &mut rich);
    let status = report.status.unwrap();
    assert_eq!((status.enabled, status.error, status.warning), (0x3f, 0, 0));
    assert_eq!(report.version.unwrap(), "6,6,XI1200,AC1200,v1.11.0");
    let normal = next_while_time_passes(&clock, &mut reader(&robot, ReportPort::Normal));
    assert_eq!(normal.state, MotionState::Ready);
}

#[test]
fn an_error_on_demand_stops_the_robot_and_is_reported() {
    let what = FaultKind::RobotError { code: 31 };
    // Enabling takes six requests. A report meets the error.
    let robot = robot(&[(what, Moment::Count(6), None)]);
    let mut client = client(&robot);
    client.enable().unwrap();
    let mut rich = reader(&robot, ReportPort::Rich);
    let reported = (0..10).find_map(|_| {
        let report = rich.next_report(LATEST).unwrap().unwrap();
        report.status.filter(|status| status.error != 0)
    });
    assert_eq!(reported.unwrap().error, 31);
    assert_eq!(code_of(client.begin_servo()), ControllerCode::Error(31));
    client.enable().unwrap();
    client.begin_servo().unwrap();
}

#[test]
fn an_emergency_stop_takes_the_motors_along() {
    let what = FaultKind::RobotError { code: 1 };
    // Enabling takes six requests. The seventh request meets the error.
    let robot = robot(&[(what, Moment::Count(6), None)]);
    let mut client = client(&robot);
    client.enable().unwrap();
    assert_eq!(code_of(client.set_mode(Mode::Servo)), ControllerCode::Error(1));
    client.clean_errors().unwrap();
    client.set_mode(Mode::Servo).unwrap();
    client.set_state(SetState::Motion).unwrap();
    let pose = client.pose().unwrap();
    let refused = client.move_to(
        &MoveTo {
            pose,
            speed_mm_per_s: 10.0,
            acceleration_mm_per_s2: 100.0,
        },
        LATEST,
    );
    assert!(refused.unwrap_err().to_string().contains("not ready"));
}

#[test]
fn connections_that_are_reset_fail_and_new_ones_work() {
    let robot = robot(&[(FaultKind::ConnectionReset, Moment::Count(7), None)]);
    let mut first = client(&robot);
    let mut development = reader(&robot, ReportPort::Development);
    development.next_report(LATEST).unwrap().unwrap();
    first.enable().unwrap();
    first.state().unwrap();
    assert!(matches!(first.state(), Err(RigError::Transport { .. })));
    assert!(matches!(first.state(), Err(RigError::Transport { .. })));
    let ended = (0..100).find_map(|_| development.next_report(LATEST).err());
    assert!(matches!(ended, Some(RigError::Transport { .. })));
    let mut second = client(&robot);
    assert_eq!(second.state().unwrap(), MotionState::Ready);
}

#[test]
fn a_robot_that_does_not_answer_is_late() {
    let robot = robot(&[(
        FaultKind::UnansweredRequests,
        Moment::Count(1),
        Some(Moment::Count(1)),
    )]);
    let mut client = client(&robot);
    client.state().unwrap();
    client.set_answer_within(Duration::from_millis(50));
    assert!(matches!(client.state(), Err(RigError::Timeout { .. })));
    client.set_answer_within(LATEST);
    client.state().unwrap();
}

#[test]
fn the_controller_alone_repeats_itself_in_virtual_time() {
    let run = || -> Vec<Vec<u8>> {
        let clock = LabClock::virtual_time();
        let what = FaultKind::RobotError { code: 31 };
        let begins = Moment::TimeS(0.9);
        let faults = [ScheduledFault {
            what,
            begins,
            lasts: None,
        }];
        let mut controller = Controller::new(workcell(&clock), RobotSettings::default(), &faults).unwrap();
        let mut heard = Vec::new();
        let mut transaction = 0;
        let mut call = |controller: &mut Controller, command: Command| {
            transaction += 1;
            let request = Request {
                transaction,
                protocol: PROTOCOL,
                command,
            };
            heard.extend(controller.respond(&request.encode()));
        };
        call(
            &mut controller,
            Command::MotionEnable {
                axis: Command::ALL_AXES,
                on: true,
            },
        );
        let (mode, detection) = (Mode::Servo, Some(0));
        call(&mut controller, Command::SetMode { mode, detection });
        call(&mut controller, Command::SetState(SetState::Motion));
        let mut pose = controller.pose();
        for step in 0..250 {
            pose = lower(&pose, 0.2);
            call(
                &mut controller,
                Command::ServoCartesian {
                    to: MoveTo {
                        pose,
                        speed_mm_per_s: 0.0,
                        acceleration_mm_per_s2: 0.0,
                    },
                    in_tool_frame: false,
                },
            );
            clock.wait_s(0.004);
            if step == 200 {
                // 50 mm/s behind a lag of 30 ms: 1.5 mm behind.
                let behind_mm = controller.pose().distance_mm(&pose);
                assert!((behind_mm - 1.5).abs() < 0.2, "{behind_mm} mm");
            }
        }
        call(&mut controller, Command::GetPose);
        heard.push(controller.report_frame(ReportPort::Rich));
        heard
    };
    let heard = run();
    assert_eq!(heard, run());
    let refused = heard
        .iter()
        .filter(|frame| frame[6] == 30 && frame[7] != 0)
        .count();
    assert_eq!(refused, 250 - 225, "from 0.9 s on");
}

#[test]
fn frames_that_make_no_sense_are_refused_or_ignored() {
    let robot = robot(&[]);
    let mut raw = TcpStream::connect(robot.commands()).unwrap();
    raw.set_read_timeout(Some(LATEST)).unwrap();
    use std::io::{Read, Write};
    // A mode that does not exist, an unknown function, standard Modbus, and then a query.
    for frame in [
        [0, 1, 0, 2, 0, 3, 19, 99, 0].as_slice(),
        &[0, 2, 0, 2, 0, 1, 240],
        &[0, 3, 0, 0, 0, 2, 1, 3],
        &[0, 4, 0, 3, 0, 1, 13],
    ] {
        raw.write_all(frame).unwrap();
    }
    let mut answers = [0; 8 + 8 + 9];
    raw.read_exact(&mut answers).unwrap();
    let invalid = 0x08 | 0x10;
    assert_eq!(answers[..8], [0, 1, 0, 2, 0, 2, 19, invalid]);
    assert_eq!(answers[8..16], [0, 2, 0, 2, 0, 2, 240, invalid]);
    assert_eq!(answers[16..], [0, 4, 0, 3, 0, 3, 13, 0x10, 4]);
    // A size that no frame has: the framing of the stream is lost, and the connection ends.
    raw.write_all(&[0, 5, 0, 2, 0xff, 0xff]).unwrap();
    assert_eq!(raw.read(&mut answers).unwrap_or(0), 0);
}

#[test]
fn dropping_the_robot_frees_its_ports() {
    let robot = robot(&[]);
    let address = robot.commands();
    let mut client = client(&robot);
    client.state().unwrap();
    drop(robot);
    assert!(client.state().is_err());
    assert!(TcpStream::connect(address).is_err());
}
