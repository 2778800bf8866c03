//! The client against a controller on the loopback, and against a pair of buffers.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;

use glam::DVec3;

use super::*;
use crate::xarm::pose_stream::{PERIOD, PoseStream};
use crate::xarm::{FEEDBACK, Pair, Report, ReportPort, ReportReader};

/// State of the arm, and how it answers.
#[derive(Clone, Debug)]
struct Arm {
    pose: TcpPose,
    mode: Mode,
    state: MotionState,
    error: u8,
    version: &'static str,
    /// The command that gets a wrong response, and what is wrong.
    fault: Option<(u8, Fault)>,
    heard: Vec<Command>,
}

#[derive(Clone, Copy, Debug)]
enum Fault {
    Error(u8),
    State(u8),
    Transaction,
    Silence,
    Truncated,
    Ignored,
}

impl Arm {
    fn new() -> Self {
        Self {
            pose: at(300.0),
            mode: Mode::Position,
            state: MotionState::Stopped,
            error: 0,
            version: "xarm6,v2.3.0",
            fault: None,
            heard: Vec::new(),
        }
    }

    fn respond(&mut self, request: &Request) -> Option<Vec<u8>> {
        self.heard.push(request.command.clone());
        let fault = self
            .fault
            .filter(|(function, _)| *function == request.command.function())
            .map(|(_, fault)| fault);
        if let Some(Fault::Error(code)) = fault {
            self.error = code;
        }
        let is_ignored = matches!(fault, Some(Fault::Ignored));
        let answer = match &request.command {
            _ if is_ignored => Answer::Done,
            Command::GetVersion => Answer::Version(self.version.into()),
            Command::GetState => Answer::State(self.state),
            Command::GetErrors => Answer::Errors {
                error: self.error,
                warning: 0,
            },
            Command::GetPose => Answer::Pose(self.pose),
            command => {
                match command {
                    Command::CleanError if self.error != 1 => self.error = 0,
                    Command::SetMode { mode, .. } => self.mode = *mode,
                    Command::SetState(SetState::Motion) => self.state = MotionState::Ready,
                    Command::SetState(SetState::Stop) => self.state = MotionState::Stopped,
                    Command::MoveLine { to, .. } | Command::ServoCartesian { to, .. } => self.pose = to.pose,
                    _ => {}
                }
                Answer::Done
            }
        };
        let mut state = ResponseState::default();
        if self.error != 0 {
            state = state | ResponseState::ERROR;
        }
        if self.state == MotionState::Stopped {
            state = state | ResponseState::NOT_READY;
        }
        let mut response = Response::to(request, state, &answer);
        match fault {
            Some(Fault::State(bits)) => response.state = ResponseState(bits),
            Some(Fault::Transaction) => response.transaction = response.transaction.wrapping_add(7),
            Some(Fault::Truncated) => response.payload.clear(),
            Some(Fault::Silence) => return None,
            Some(Fault::Error(_) | Fault::Ignored) | None => {}
        }
        Some(response.encode())
    }
}

fn at(height_mm: f64) -> TcpPose {
    TcpPose {
        position_mm: DVec3::new(200.0, 0.0, height_mm),
        roll_pitch_yaw_rad: DVec3::new(3.0, 0.0, 0.0),
    }
}

fn to(pose: TcpPose) -> MoveTo {
    MoveTo {
        pose,
        speed_mm_per_s: 50.0,
        acceleration_mm_per_s2: 500.0,
    }
}

/// A wait that is longer than any delay of a busy machine.
const LATEST: Duration = Duration::from_secs(60);

/// A client that waits as long as a busy machine may need.
fn connected(address: SocketAddr) -> Client<TcpStream> {
    let mut client = Client::connect(address).unwrap();
    client.set_answer_within(LATEST);
    client
}

/// Serves one connection. Each response comes in two pieces, after a frame of feedback.
fn controller(arm: Arm) -> (SocketAddr, Arc<Mutex<Arm>>, JoinHandle<()>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let arm = Arc::new(Mutex::new(arm));
    let shared = Arc::clone(&arm);
    let server = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        stream.set_nodelay(true).unwrap();
        let mut splitter = splitter();
        let mut bytes = [0; 256];
        while let Ok(size @ 1..) = stream.read(&mut bytes) {
            let mut chunk = &bytes[..size];
            while let Some(frame) = splitter.take(&mut chunk).unwrap() {
                let request = Request::decode(&frame).unwrap();
                let Some(response) = shared.lock().unwrap().respond(&request) else {
                    continue;
                };
                let (front, rest) = response.split_at(5);
                let pieces = [&[0, 0, 0, 2, 0, 3, FEEDBACK, 1, 2][..], front, rest];
                // A client may leave without reading the last response.
                if pieces.iter().any(|piece| stream.write_all(piece).is_err()) {
                    return;
                }
            }
        }
    });
    (address, arm, server)
}

#[test]
fn a_session_from_enabling_to_stopping() {
    let (address, arm, server) = controller(Arm {
        error: 22,
        ..Arm::new()
    });
    let mut client = connected(address);
    client.enable().unwrap();
    client.move_to(&to(at(250.0)), LATEST).unwrap();
    let start = client.begin_servo().unwrap();
    assert_eq!(start, at(250.0));
    let first_due = client.servo.unwrap().due;
    for step in 1..=50 {
        client.servo(&at(250.0 - 0.2 * f64::from(step))).unwrap();
    }
    assert!(client.servo.unwrap().due >= first_due + 50 * PERIOD);
    assert!(
        Instant::now() >= first_due + 49 * PERIOD,
        "none went out before it was due"
    );
    assert!(client.pose().unwrap().distance_mm(&at(240.0)) < 1e-4);
    client.stop().unwrap();
    assert!(client.servo(&at(240.0)).is_err(), "the stream has ended");
    assert_eq!(client.state().unwrap(), MotionState::Stopped);
    drop(client);
    server.join().unwrap();
    let functions: Vec<u8> = arm.lock().unwrap().heard.iter().map(Command::function).collect();
    // Version, clear twice, enable, mode, state; the move, with errors, state and pose; mode,
    // state, state, pose; servo; pose; stop; state.
    assert_eq!(functions[..10], [1, 16, 17, 11, 19, 12, 21, 15, 13, 41]);
    assert_eq!(functions[10..15], [19, 12, 13, 41, 30]);
    assert_eq!(functions[63..], [30, 41, 12, 13]);
}

#[test]
fn errors_have_names_and_end_the_stream() {
    for (function, fault, words) in [
        (
            30,
            Fault::Error(31),
            "robot: error 31 (collision: a motor draws too much current; ",
        ),
        (
            30,
            Fault::State(0x10),
            "robot: servo: the robot is not ready to move; enable it again",
        ),
        (
            30,
            Fault::State(0x08),
            "robot: servo: the robot calls the result invalid",
        ),
        (
            30,
            Fault::State(0x20),
            "robot: servo: the robot reports an error without a code",
        ),
        (30, Fault::Transaction, "robot: transaction: expected "),
        (
            41,
            Fault::Truncated,
            "robot: payload: expected the answer to get pose, found 0 bytes",
        ),
        (
            21,
            Fault::Error(35),
            "robot: error 35 (outside the safety boundary; ",
        ),
        (11, Fault::Error(1), "robot: error 1 (emergency stop; "),
        (
            13,
            Fault::State(0x08),
            "robot: get state: the robot calls the result invalid",
        ),
    ] {
        let (address, _, server) = controller(Arm {
            fault: Some((function, fault)),
            ..Arm::new()
        });
        let mut client = connected(address);
        let mut session = || {
            client.enable()?;
            client.move_to(&to(at(250.0)), LATEST)?;
            client.begin_servo()?;
            // The error of the first pose comes with one of the next poses.
            let begun = Instant::now();
            while begun.elapsed() < LATEST {
                client.servo(&at(249.9))?;
            }
            Ok(())
        };
        let error: RigError = session().unwrap_err();
        if function == 30
            && error
                .to_string()
                .ends_with("an error without a code; enable it again")
        {
            // A code that took longer than a servo period.
            match client.errors().unwrap() {
                Some(code) => assert!(format!("robot: {code}").starts_with(words), "{code}"),
                None => assert!(words.ends_with("an error without a code"), "{words}"),
            }
        } else {
            assert!(error.to_string().starts_with(words), "{error}");
        }
        let again = client.servo(&at(249.8)).unwrap_err().to_string();
        assert!(again.contains("no stream of poses was started"), "{again}");
        drop(client);
        server.join().unwrap();
    }
}

#[test]
fn an_emergency_stop_cannot_be_cleaned() {
    let (address, _, server) = controller(Arm {
        error: 1,
        ..Arm::new()
    });
    let mut client = connected(address);
    let error = client.enable().unwrap_err().to_string();
    assert!(
        error.contains("emergency stop") && error.ends_with("after enable motion"),
        "{error}"
    );
    drop(client);
    server.join().unwrap();
}

#[test]
fn steps_are_limited() {
    for (height_mm, is_sent) in [(295.0, true), (289.9, false), (f64::NAN, false)] {
        let (address, arm, server) = controller(Arm::new());
        let mut client = connected(address);
        client.enable().unwrap();
        client.begin_servo().unwrap();
        std::thread::sleep(Duration::from_millis(15));
        assert_eq!(client.servo(&at(height_mm)).is_ok(), is_sent, "{height_mm}");
        if is_sent {
            assert!(client.servo(&at(height_mm + 10.1)).is_err());
        }
        drop(client);
        server.join().unwrap();
        let sent = arm
            .lock()
            .unwrap()
            .heard
            .iter()
            .filter(|command| command.function() == 30)
            .count();
        assert_eq!(sent, usize::from(is_sent));
    }
}

#[test]
fn silence_is_noticed_and_late_answers_are_passed_over() {
    let (address, arm, server) = controller(Arm {
        fault: Some((13, Fault::Silence)),
        ..Arm::new()
    });
    let mut client = connected(address);
    client.set_answer_within(Duration::from_millis(50));
    let error = client.state().unwrap_err().to_string();
    assert_eq!(error, "robot: no answer to get state within 0.05 s");
    arm.lock().unwrap().fault = None;
    client.set_answer_within(LATEST);
    assert_eq!(client.state().unwrap(), MotionState::Stopped);
    drop(client);
    server.join().unwrap();

    let command = Command::GetState;
    let late = |transaction| {
        let request = Request {
            transaction,
            protocol: PROTOCOL,
            command: command.clone(),
        };
        let answer = Answer::State(MotionState::from_code(transaction as u8));
        Response::to(&request, ResponseState::default(), &answer).encode()
    };
    let mut client = Client::new(Pair {
        reader: std::io::Cursor::new([late(1), late(2)].concat()),
        writer: Vec::new(),
    });
    client.transaction = 1;
    let old = Request {
        transaction: 1,
        protocol: PROTOCOL,
        command: Command::GetState,
    };
    client.remember(&old, false);
    assert_eq!(client.state().unwrap(), MotionState::Ready, "the second one's");
    assert_eq!(client.reader.wire.writer, [0, 2, 0, 2, 0, 1, 13]);
    assert!(
        client.state().unwrap_err().to_string().contains("receiving"),
        "the connection has ended"
    );
}

#[test]
fn poses_wait_for_no_answer_and_a_stop_goes_out_before_any() {
    let (address, arm, server) = controller(Arm {
        fault: Some((30, Fault::Silence)),
        ..Arm::new()
    });
    let mut client = connected(address);
    client.enable().unwrap();
    client.begin_servo().unwrap();
    let begun = Instant::now();
    for step in 1..=20 {
        client.servo(&at(300.0 - 0.1 * f64::from(step))).unwrap();
    }
    assert!(begun.elapsed() < LATEST, "it waits for answers");
    assert!(
        client.hear().unwrap() >= 19 * PERIOD / 2,
        "poses are at least half a period apart"
    );
    client.stop().unwrap();
    assert_eq!(
        client.hear().unwrap(),
        Duration::ZERO,
        "nobody owes a pose any more"
    );

    // A stream ends if its responses do not come.
    client.enable().unwrap();
    client.begin_servo().unwrap();
    client.set_answer_within(Duration::from_millis(50));
    let begun = Instant::now();
    let error = loop {
        assert!(begun.elapsed() < LATEST);
        if let Err(error) = client.servo(&at(298.0)) {
            break error.to_string();
        }
    };
    assert_eq!(error, "robot: no answer to servo within 0.05 s");
    assert!(client.servo(&at(298.0)).is_err(), "the stream has ended");
    drop(client);
    server.join().unwrap();
    let heard = &arm.lock().unwrap().heard;
    assert!(heard.contains(&Command::SetState(SetState::Stop)));
}

/// Endless feedback.
struct Flood;

impl Read for Flood {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        let feedback = [0, 0, 0, 2, 0, 3, FEEDBACK, 1, 2];
        bytes[..feedback.len()].copy_from_slice(&feedback);
        Ok(feedback.len())
    }
}

#[test]
fn a_robot_that_never_stops_talking_holds_nobody_up() {
    let mut client = Client::new(Pair {
        reader: Flood,
        writer: std::io::sink(),
    });
    assert_eq!(client.hear().unwrap(), Duration::ZERO);
}

#[test]
fn an_error_passed_over_ends_the_stream() {
    let request = |transaction, command| Request {
        transaction,
        protocol: PROTOCOL,
        command,
    };
    let pose = request(
        1,
        Command::ServoCartesian {
            to: to(at(300.0)),
            in_tool_frame: false,
        },
    );
    let question = request(2, Command::GetState);
    let refused = Response::to(&pose, ResponseState::INVALID, &Answer::Done);
    let answer = Answer::State(MotionState::Ready);
    let answered = Response::to(&question, ResponseState::default(), &answer);
    let mut client = Client::new(Pair {
        reader: std::io::Cursor::new([refused.encode(), answered.encode()].concat()),
        writer: Vec::new(),
    });
    client.transaction = 1;
    client.remember(&pose, true);
    client.servo = Some(PoseStream::at(at(300.0)));
    assert_eq!(client.state().unwrap(), MotionState::Ready);
    assert!(client.servo.is_none());
}

#[test]
fn transactions_wrap_to_one() {
    let mut client = Client::new(Pair {
        reader: std::io::empty(),
        writer: Vec::new(),
    });
    client.transaction = u16::MAX - 1;
    for _ in 0..2 {
        assert!(client.state().is_err());
    }
    let sent: Vec<&[u8]> = client.reader.wire.writer.chunks(7).collect();
    assert_eq!(sent, [[0xff, 0xff, 0, 2, 0, 1, 13], [0, 1, 0, 2, 0, 1, 13]]);
}

#[test]
fn old_firmware_is_not_told_how_to_detect_collisions() {
    for (version, wants) in [
        ("xarm6,v2.3.0", true),
        ("v1.10.2", true),
        ("v1.9.0", false),
        ("XARM6,XS1203,V1.6.1", false),
        ("", true),
        ("vx", true),
    ] {
        assert_eq!(wants_detection(version), wants, "{version}");
    }
    let (address, arm, server) = controller(Arm {
        version: "v1.8.4",
        ..Arm::new()
    });
    let mut client = connected(address);
    client.enable().unwrap();
    drop(client);
    server.join().unwrap();
    let mode = Command::SetMode {
        mode: Mode::Position,
        detection: None,
    };
    assert!(arm.lock().unwrap().heard.contains(&mode));
}

#[test]
fn a_move_that_does_not_arrive_is_stopped() {
    let (address, arm, server) = controller(Arm {
        fault: Some((21, Fault::Ignored)),
        ..Arm::new()
    });
    let mut client = connected(address);
    client.enable().unwrap();
    let error = client
        .move_to(&to(at(250.0)), Duration::from_millis(50))
        .unwrap_err()
        .to_string();
    assert_eq!(
        error,
        "robot: move: the robot does not reach the pose within 0.05 s; check what blocks it, or allow more time"
    );
    assert_eq!(client.state().unwrap(), MotionState::Stopped);
    assert_eq!(arm.lock().unwrap().pose, at(300.0));
    drop(client);
    server.join().unwrap();
}

#[test]
fn reports_are_read_from_a_stream() {
    let report = |height_mm| Report {
        state: MotionState::Ready,
        mode: 1,
        command_count: 0,
        joints_rad: [0.0; 7],
        pose: at(height_mm),
        joint_torques: [0.0; 7],
        status: None,
        wrench: None,
        version: None,
    };
    let port = ReportPort::Development;
    let stream: Vec<u8> = [300.0, 299.0]
        .iter()
        .flat_map(|height_mm| report(*height_mm).encode(port))
        .collect();
    let mut reader = ReportReader::new(
        Pair {
            reader: std::io::Cursor::new(stream),
            writer: std::io::sink(),
        },
        port,
    );
    for height_mm in [300.0, 299.0] {
        let found = reader.next_report(LATEST).unwrap().unwrap();
        assert_eq!(found.pose, at(height_mm));
    }
    assert!(reader.next_report(LATEST).is_err(), "the stream has ended");
}
