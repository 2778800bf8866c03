use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::TcpPose;
use crate::xarm::{Mode, MotionState, MoveTo, SetState};

fn bytes(text: &str) -> Vec<u8> {
    text.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).unwrap())
        .collect()
}

#[test]
fn frames_are_those_of_the_manufacturers_client() {
    let down = TcpPose {
        position_mm: DVec3::new(200.0, 0.0, 200.0),
        roll_pitch_yaw_rad: DVec3::new(f64::from(std::f32::consts::PI), 0.0, 0.0),
    };
    let servo = Command::ServoCartesian {
        to: MoveTo {
            pose: down,
            speed_mm_per_s: 100.0,
            acceleration_mm_per_s2: 2000.0,
        },
        in_tool_frame: false,
    };
    let mode = Command::SetMode {
        mode: Mode::Servo,
        detection: Some(0),
    };
    let enable = Command::MotionEnable {
        axis: Command::ALL_AXES,
        on: true,
    };
    for (transaction, command, text) in [
        (1, enable, "00 01 00 02 00 03 0b 08 01"),
        (2, mode, "00 02 00 02 00 03 13 01 00"),
        (3, Command::SetState(SetState::Motion), "00 03 00 02 00 02 0c 00"),
        (4, Command::GetState, "00 04 00 02 00 01 0d"),
        (5, Command::GetErrors, "00 05 00 02 00 01 0f"),
        (6, Command::GetPose, "00 06 00 02 00 01 29"),
        (
            7,
            servo,
            "00 07 00 02 00 25 1e 00 00 48 43 00 00 00 00 00 00 48 43 db 0f 49 40 00 00 00 00 00 00 00 00 \
             00 00 c8 42 00 00 fa 44 00 00 00 00",
        ),
    ] {
        let request = Request {
            transaction,
            protocol: PROTOCOL,
            command,
        };
        assert_eq!(request.encode(), bytes(text), "{}", request.command.name());
        assert_eq!(Request::decode(&bytes(text)).unwrap(), request);
    }
}

#[test]
fn answers_are_read() {
    for (command, text, answer) in [
        (
            Command::GetState,
            "00 04 00 02 00 03 0d 00 02",
            Answer::State(MotionState::Ready),
        ),
        (
            Command::GetErrors,
            "00 04 00 02 00 04 0f 40 1f 0b",
            Answer::Errors {
                error: 31,
                warning: 11,
            },
        ),
        (
            Command::GetCommandCount,
            "00 04 00 02 00 04 0e 00 01 02",
            Answer::CommandCount(258),
        ),
        (Command::CleanError, "00 04 00 02 00 02 10 00", Answer::Done),
        (
            Command::GetVersion,
            "00 04 00 02 00 07 01 00 76 31 2e 32 00",
            Answer::Version("v1.2".into()),
        ),
    ] {
        let request = Request {
            transaction: 4,
            protocol: PROTOCOL,
            command,
        };
        let Incoming::Response(response) = Incoming::decode(&bytes(text)).unwrap() else {
            panic!("{text}");
        };
        assert_eq!(response.answer(&request).unwrap(), answer);
    }
}

#[test]
fn responses_to_something_else_are_not_answers() {
    let request = Request {
        transaction: 4,
        protocol: PROTOCOL,
        command: Command::GetState,
    };
    for (text, words) in [
        ("00 05 00 02 00 03 0d 00 02", "transaction: expected 4, found 5"),
        ("00 04 00 00 00 03 0d 00 02", "protocol: expected 2, found 0"),
        ("00 04 00 02 00 03 0e 00 02", "function: expected 13, found 14"),
        (
            "00 04 00 02 00 02 0d 00",
            "payload: expected the answer to get state, found 0 bytes",
        ),
    ] {
        let Incoming::Response(response) = Incoming::decode(&bytes(text)).unwrap() else {
            panic!("{text}");
        };
        let error = response.answer(&request).unwrap_err().to_string();
        assert_eq!(error, format!("robot: {words}"));
    }
    assert_eq!(
        Incoming::decode(&bytes("00 00 00 02 00 03 ff 01 02")).unwrap(),
        Incoming::Feedback(vec![1, 2])
    );
    assert!(
        Incoming::decode(&bytes("00 04 00 02 00 01 0d")).is_err(),
        "no state"
    );
    assert!(
        Incoming::decode(&bytes("00 04 00 02 00 04 0d 00 02")).is_err(),
        "not whole"
    );
    assert!(
        Request::decode(&bytes("00 01 00 02 00 02 0c 05")).is_err(),
        "no state 5 to set"
    );
    assert!(
        Request::decode(&bytes("00 01 00 02 00 02 0b 08")).is_err(),
        "half a payload"
    );
}

#[test]
fn streams_split_wherever_the_reads_fall_and_too_large_frames_end_them() {
    let text = "00 01 00 02 00 02 0b 00  00 02 00 02 00 03 0d 00 02  00 00 00 02 00 01 ff";
    let stream = bytes(text);
    for size in 1..=stream.len() {
        let mut splitter = splitter();
        let mut sizes = Vec::new();
        for mut chunk in stream.chunks(size) {
            while let Some(frame) = splitter.take(&mut chunk).unwrap() {
                sizes.push(frame.len());
            }
        }
        assert_eq!(sizes, [8, 9, 7]);
    }
    for header in ["00 01 00 02 04 00", "00 01 00 02 00 00"] {
        let header = bytes(header);
        assert!(splitter().take(&mut header.as_slice()).is_err(), "{header:?}");
    }
}

fn pose() -> impl Strategy<Value = TcpPose> + Clone {
    any::<[f32; 6]>()
        .prop_filter("NaN is unequal to itself", |numbers| {
            numbers.iter().all(|number| !number.is_nan())
        })
        .prop_map(crate::xarm::bytes::pose)
}

fn command() -> impl Strategy<Value = Command> {
    let state = prop_oneof![
        Just(SetState::Motion),
        Just(SetState::Pause),
        Just(SetState::Stop),
        Just(SetState::DecelerationStop),
    ];
    let mode = (0..8_u8).prop_filter_map("a mode", Mode::from_code);
    let to = (pose(), 0.0..1e4_f32, 0.0..1e5_f32).prop_map(|(pose, speed, acceleration)| MoveTo {
        pose,
        speed_mm_per_s: speed.into(),
        acceleration_mm_per_s2: acceleration.into(),
    });
    prop_oneof![
        Just(Command::GetVersion),
        (any::<u8>(), any::<bool>()).prop_map(|(axis, on)| Command::MotionEnable { axis, on }),
        state.prop_map(Command::SetState),
        (mode, any::<Option<u8>>()).prop_map(|(mode, detection)| Command::SetMode { mode, detection }),
        (to.clone(), 0.0..9.0_f32).prop_map(|(to, time_s)| Command::MoveLine {
            to,
            time_s: time_s.into()
        }),
        (to, any::<bool>()).prop_map(|(to, in_tool_frame)| Command::ServoCartesian { to, in_tool_frame }),
        Just(Command::GetPose),
        (200..=212_u8, prop::collection::vec(any::<u8>(), 0..60))
            .prop_map(|(function, payload)| Command::Other { function, payload }),
    ]
}

fn answer() -> impl Strategy<Value = (Command, Answer)> {
    prop_oneof![
        Just((Command::CleanError, Answer::Done)),
        "[ -~]{0,39}".prop_map(|text| (Command::GetVersion, Answer::Version(text))),
        any::<u8>().prop_map(|code| (Command::GetState, Answer::State(MotionState::from_code(code)))),
        any::<u16>().prop_map(|count| (Command::GetCommandCount, Answer::CommandCount(count))),
        any::<[u8; 2]>().prop_map(|[error, warning]| (Command::GetErrors, Answer::Errors { error, warning })),
        pose().prop_map(|pose| (Command::GetPose, Answer::Pose(pose))),
        prop::array::uniform7(-7.0..7.0_f32).prop_map(|joints| (Command::GetJoints, Answer::Joints(joints))),
    ]
}

proptest! {
    #[test]
    fn requests_come_back(transaction in any::<u16>(), protocol in any::<u16>(), command in command()) {
        let request = Request { transaction, protocol, command };
        prop_assert_eq!(Request::decode(&request.encode()).unwrap(), request);
    }

    #[test]
    fn answers_come_back(transaction in any::<u16>(), state in any::<u8>(), (command, answer) in answer()) {
        let request = Request { transaction, protocol: PROTOCOL, command };
        let response = Response::to(&request, ResponseState(state), &answer);
        let Incoming::Response(back) = Incoming::decode(&response.encode()).unwrap() else {
            return Err(TestCaseError::fail("no response"));
        };
        prop_assert_eq!(&back, &response);
        prop_assert_eq!(back.answer(&request).unwrap(), answer);
    }
}
