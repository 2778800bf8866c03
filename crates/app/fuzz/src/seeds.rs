//! Valid inputs, from documents and from this project's encoders. Fuzzing starts with them.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use twintac_log::{
    Body, CountTransfer, Description, Event, LogWriter, Message, PoseReading, Stream, TactileFrame,
    TaxelReading, TaxelState, WrenchReading,
};
use twintac_recording::{Control, Provenance};
use twintac_rig::TcpPose;
use twintac_rig::netft::{self, Record, Status, encode_records};
use twintac_rig::xarm::{
    Answer, Command, Mode, MotionState, MoveTo, PROTOCOL, RealTimeReport, Report, ReportPort, Request,
    Response, ResponseState, RobotStatus, RobotWrench, SetState,
};
use twintac_shape::Pose;

pub(crate) const PAGE: &str = "<?xml version=\"1.0\"?>\n<netFTApi><prodname>Net F/T</prodname><cfgcpf>1000000</cfgcpf>\
    <cfgcpt>1000000</cfgcpt><scfgfu>N</scfgfu><scfgtu>Nm</scfgtu><comrdtrate>7000</comrdtrate></netFTApi>";
const CAL: &str = "<FTSensor><Calibration ForceUnits=\"N\" TorqueUnits=\"N-m\">\
    <UserAxis Name=\"Fx\" values=\"1 2 3 4 5 6\"/><UserAxis Name=\"Fy\" values=\"1 2 3 4 5 6\"/>\
    <UserAxis Name=\"Fz\" values=\"1 2 3 4 5 6\"/><UserAxis Name=\"Tx\" values=\"1 2 3 4 5 6\"/>\
    <UserAxis Name=\"Ty\" values=\"1 2 3 4 5 6\"/><UserAxis Name=\"Tz\" values=\"1 2 3 4 5 6\"/></Calibration></FTSensor>";
const TOML: &str = "range_v = 10.0\nbias_v = [0, 0, 0, 0, 0, 0.5]\nmatrix = [[1, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0],\
    [0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, 0, 0, 0, 1]]\n";
const CSV: &str = "time_s,fx_n,fy_n,fz_n,tx_n_mm,ty_n_mm,tz_n_mm\n0.0,1,2,3,4,5,6\n0.1,-1,-2,-3,4e2,5,6\n";

/// Start of the clock of these logs.
pub(crate) const START_UNIX_NS: u64 = 1_700_000_000_000_000_000;

fn at(height_mm: f64) -> TcpPose {
    TcpPose {
        position_mm: DVec3::new(200.0, 0.0, height_mm),
        roll_pitch_yaw_rad: DVec3::new(std::f64::consts::PI, 0.0, 0.0),
    }
}

/// A session from enabling to stopping, with all requests.
fn session() -> Vec<(Command, Answer)> {
    let to = |height_mm| MoveTo {
        pose: at(height_mm),
        speed_mm_per_s: 100.0,
        acceleration_mm_per_s2: 2000.0,
    };
    let mode = |mode, detection| Command::SetMode { mode, detection };
    let version = Answer::Version("6,6,XI1200,AC1200,v1.11.0".to_owned());
    vec![
        (Command::GetVersion, version),
        (Command::CleanError, Answer::Done),
        (Command::CleanWarning, Answer::Done),
        (Command::MotionEnable { axis: 8, on: true }, Answer::Done),
        (mode(Mode::Position, None), Answer::Done),
        (Command::SetState(SetState::Motion), Answer::Done),
        (Command::GetState, Answer::State(MotionState::Ready)),
        (Command::GetErrors, Answer::Errors { error: 0, warning: 0 }),
        (Command::GetPose, Answer::Pose(at(150.0))),
        (Command::SetState(SetState::Stop), Answer::Done),
        (Command::SetState(SetState::Motion), Answer::Done),
        (
            Command::MoveLine {
                to: to(149.0),
                time_s: 0.0,
            },
            Answer::Done,
        ),
        (mode(Mode::Servo, Some(0)), Answer::Done),
        (Command::SetState(SetState::Motion), Answer::Done),
        (
            Command::ServoCartesian {
                to: to(148.0),
                in_tool_frame: false,
            },
            Answer::Done,
        ),
        (
            Command::ServoCartesian {
                to: to(-1.0),
                in_tool_frame: true,
            },
            Answer::Done,
        ),
        (Command::GetJoints, Answer::Joints([0.1; 7])),
        (Command::GetCommandCount, Answer::CommandCount(3)),
        (Command::SetState(SetState::Pause), Answer::Done),
    ]
}

fn requests() -> Vec<Request> {
    let commands = session().into_iter().map(|(command, _)| command);
    let numbered = (1..).zip(commands).map(|(transaction, command)| Request {
        transaction,
        protocol: PROTOCOL,
        command,
    });
    numbered.collect()
}

pub(crate) fn xarm_frames() -> Vec<Vec<u8>> {
    let answers: Vec<Vec<u8>> = requests()
        .iter()
        .zip(session())
        .map(|(request, (_, answer))| Response::to(request, ResponseState::default(), &answer).encode())
        .collect();
    let feedback = vec![0, 0, 0, 2, 0, 3, 0xff, 1, 2];
    vec![
        answers[..10].concat(),
        answers.concat(),
        [feedback, answers[0].clone()].concat(),
    ]
    .into_iter()
    .chain(xarm_requests())
    .collect()
}

pub(crate) fn xarm_requests() -> Vec<Vec<u8>> {
    let frames: Vec<Vec<u8>> = requests().iter().map(Request::encode).collect();
    vec![frames.concat(), frames[3..].concat()]
}

pub(crate) fn xarm_reports() -> Vec<Vec<u8>> {
    let report = Report {
        state: MotionState::Moving,
        mode: 1,
        command_count: 258,
        joints_rad: [0.1; 7],
        pose: at(200.0),
        joint_torques: [1.0; 7],
        status: Some(RobotStatus {
            brakes: 0x3f,
            enabled: 0x3f,
            error: 31,
            warning: 11,
            tcp_offset: at(0.0),
            payload: [0.5, 0.0, 0.0, 40.0],
            collision_sensitivity: 3,
            teach_sensitivity: 2,
            gravity: Some([0.0, 0.0, -1.0]),
        }),
        wrench: Some(RobotWrench {
            external: [1.0; 6],
            raw: [2.0; 6],
        }),
        version: Some("v2.3.0".to_owned()),
    };
    let real_time = RealTimeReport {
        stamp: 0x0102_0304,
        target_joints_rad: [0.1; 7],
        joints_rad: [0.2; 7],
        target_pose: at(200.0),
        pose: at(199.0),
        speed: [7.0; 6],
    };
    let mut frames: Vec<Vec<u8>> = [ReportPort::Normal, ReportPort::Rich, ReportPort::Development]
        .map(|port| report.encode(port))
        .to_vec();
    frames.push(real_time.encode());
    frames.push([frames[0].clone(), frames[2].clone()].concat());
    frames
}

pub(crate) fn netft_datagrams() -> Vec<Vec<u8>> {
    let record = |number: u32| Record {
        rdt_sequence: number,
        ft_sequence: 7 * number,
        status: Status(if number == 4 { 0x8001_0000 } else { 0 }),
        counts: [1, -2, 1_000_000, i32::MIN, i32::MAX, 0],
    };
    let records: Vec<Record> = [1, 2, 4, 3, 4, 9].map(record).to_vec();
    let request = |command| netft::Request { command, samples: 0 }.encode();
    let (stop, bias, latch) = (
        netft::Command::Stop,
        netft::Command::Bias,
        netft::Command::ResetLatch,
    );
    let (start, buffered) = (netft::Command::StartRealTime, netft::Command::StartBuffered);
    vec![
        encode_records(&records[..1]),
        encode_records(&records),
        request(start).to_vec(),
        [start, bias, latch, buffered, stop].map(request).concat(),
    ]
}

pub(crate) fn texts() -> Vec<Vec<u8>> {
    let text = |(kind, text): (u8, &str)| [&[kind], text.as_bytes()].concat();
    (0..).zip([PAGE, CAL, TOML, CSV]).map(text).collect()
}

fn description() -> Description {
    let upside_down = DQuat::from_rotation_x(std::f64::consts::PI);
    Description {
        sensor: "two".to_owned(),
        sensor_toml: "name = \"two\"\n".to_owned(),
        provenance: Provenance::Emulated,
        taxels: vec!["S0".to_owned(), "S1".to_owned()],
        transfer: Some(CountTransfer {
            pa_per_count: 0.03125,
            offset_pa: 0.0,
            signed: true,
            is_confirmed: true,
        }),
        base_from_gel: Pose {
            position_mm: DVec3::new(200.0, 0.0, 90.0),
            rotation: DQuat::IDENTITY,
        },
        tool_from_indenter: Pose {
            position_mm: DVec3::ZERO,
            rotation: upside_down,
        },
        force_axis: DVec3::NEG_Z,
        start_unix_ns: START_UNIX_NS,
        versions: BTreeMap::new(),
    }
}

/// One press, with a gap in it.
fn press() -> Vec<Message> {
    let frame = |n: u64| {
        let taxel = |state, counts| TaxelReading {
            state,
            read_us: 1000 * n + 7,
            counts,
            pressure_pa: counts.map(|counts: i32| f64::from(counts) / 32.0),
            temperature_c: counts.map(|_| 25.5),
        };
        let missing = taxel(TaxelState::Missing, None);
        let good = taxel(TaxelState::Good, Some(3_242_400 + n as i32));
        Body::Tactile(TactileFrame {
            triggered_us: 1000 * n,
            taxels: vec![good, if n == 3 { missing } else { good }],
        })
    };
    let wrench = |n: u32| {
        Body::Wrench(WrenchReading {
            source_s: Some(f64::from(n) * 1e-3),
            sequence: Some(n),
            status: 0,
            lost_before: u32::from(n == 5),
            force_n: DVec3::new(0.1, 0.0, -f64::from(n)),
            torque_n_mm: DVec3::ZERO,
        })
    };
    let pose = |n: u32| {
        Body::Pose(PoseReading {
            source_s: None,
            position_mm: DVec3::new(200.0, 0.0, 100.0 - 0.1 * f64::from(n)),
            base_from_tool: DQuat::from_rotation_x(std::f64::consts::PI),
        })
    };
    let name = || "ball#000".to_owned();
    let events = [
        Event::Tare {
            force_n: DVec3::Z,
            torque_n_mm: DVec3::ZERO,
        },
        Event::PressBegun {
            name: name(),
            indenter: "ball".to_owned(),
            control: Control::Pose,
        },
        Event::Gap {
            stream: Some(Stream::Pose),
            cause: "nothing came".to_owned(),
            from_ns: 50_000_000,
            to_ns: 60_000_000,
            lost: Some(1),
        },
        Event::Stopped {
            cause: "force".to_owned(),
        },
        Event::PressEnded { name: name() },
    ];
    let mut messages = Vec::new();
    for n in 0..8_u32 {
        let time_s = 0.02 * f64::from(n + 1);
        messages.push(Message::at_s(time_s, wrench(n)));
        messages.push(Message::at_s(time_s, pose(n)));
        messages.push(Message::at_s(time_s + 1e-3, frame(n.into())));
        let event = match n {
            0 => Some(0),
            1 => Some(1),
            3 => Some(2),
            6 => Some(3),
            7 => Some(4),
            _ => None,
        };
        messages.extend(event.map(|event: usize| Message::at_s(time_s, Body::Event(events[event].clone()))));
    }
    messages
}

/// A log up to its first message.
pub(crate) fn log_start() -> Vec<u8> {
    let (mut log, start_bytes) = written(&[]);
    log.truncate(start_bytes);
    without_definitions(&log)
}

/// The same log without the texts of its schemas: they are half of its bytes, and the reader does
/// not use them.
fn without_definitions(log: &[u8]) -> Vec<u8> {
    let (magic, mut rest) = log.split_at(8);
    let mut short = magic.to_vec();
    while let Some(([kind, length @ ..], after)) = rest.split_first_chunk::<9>() {
        let (content, after) = after.split_at(u64::from_le_bytes(*length) as usize);
        rest = after;
        let name_bytes = usize::from(content[2]);
        let kept = if *kind == SCHEMA {
            &content[..6 + name_bytes]
        } else {
            content
        };
        short.push(*kind);
        short.extend((kept.len() as u64).to_le_bytes());
        short.extend(kept);
    }
    short.extend(rest);
    short
}

/// A whole log, a cut one, a damaged one, and one without a checksum, so that the fuzzer can change
/// the content of its chunk.
pub(crate) fn log_files() -> Vec<Vec<u8>> {
    let (whole, end) = written(&press());
    let cut = without_definitions(&whole[..end]);
    let whole = without_definitions(&whole);
    let start = log_start().len();
    let mut damaged = whole.clone();
    damaged[start + 200] ^= 1;
    let mut unchecked = whole.clone();
    unchecked[start + CHECKSUM_AT..][..4].fill(0);
    vec![log_start(), cut, whole, damaged, unchecked]
}

/// The messages of this project's types from a log: a channel, a length, a time step, and the bytes
/// of each.
pub(crate) fn log_messages() -> Vec<Vec<u8>> {
    let whole = without_definitions(&written(&press()).0);
    let mut rest = &whole[log_start().len() + CHUNK_START_BYTES..];
    let (mut all, mut seeds) = (Vec::new(), Vec::new());
    while let Some(([MESSAGE, length @ ..], after)) = rest.split_first_chunk::<9>() {
        let (content, after) = after.split_at(u64::from_le_bytes(*length) as usize);
        rest = after;
        let (channel, data) = (content[0] - 1, &content[22..]);
        if channel < 4 && data.len() < 256 {
            let message = [&[channel, data.len() as u8, 10], data].concat();
            all.extend(&message);
            seeds.push(message);
        }
    }
    seeds.truncate(6);
    seeds.push(all);
    seeds
}

const SCHEMA: u8 = 0x03;
pub(crate) const MESSAGE: u8 = 0x05;
/// Offsets in a chunk: of its checksum, and of its first message.
const CHECKSUM_AT: usize = 9 + 3 * 8;
const CHUNK_START_BYTES: usize = CHECKSUM_AT + 4 + 4 + 8;

/// A whole log, and its length if it had been cut before its end.
fn written(messages: &[Message]) -> (Vec<u8>, usize) {
    let mut writer = LogWriter::new(Vec::new(), &description()).unwrap();
    for message in messages {
        writer.write(message).unwrap();
    }
    writer.flush().unwrap();
    let end = writer.written_bytes() as usize;
    (writer.finish().unwrap(), end)
}

/// Calls and a chip, then a bus without faults, one with a missing taxel, and one that hangs.
pub(crate) fn taxel_bus() -> Vec<Vec<u8>> {
    let counts = [0x00, 0x31, 0x79, 0x80, 0x19, 0x80];
    let frame = counts.repeat(40);
    let mut missing = frame.clone();
    missing[100] = 0xF0;
    let mut hung = frame.clone();
    hung[60..120].fill(0xFB);
    let calls = |calls: u8, chip: u8, bytes: &[u8]| [&[calls, chip], bytes].concat();
    let mut seeds = vec![
        calls(0, 0, &frame),
        calls(1, 0, &frame),
        calls(0xFF, 0, &missing),
        calls(4, 0, &hung),
    ];
    // For every other chip, a bus with arbitrary data.
    seeds.extend((1..11).map(|chip| calls(0, chip, &frame)));
    seeds
}

/// A form and a size of pieces, then lines and packets as boards send them.
pub(crate) fn lines() -> Vec<Vec<u8>> {
    let texts: [&[u8]; 4] = [
        b"ESP-ROM:esp32s3\r\n1,100,101325,nan,25.5*3a\r\n# comment\n2,110,101330,101200,25.5*00\r\n",
        b"{\"n\": 1, \"t\": 1000, \"p\": [100.5, null]}\n{\"n\": 2, \"t\": 2000, \"p\":\n",
        b"\xAA\x55\x01\x00\x00\x00\x10\x27\x20\x4e\xAA\x55\x02\x00\x00\x00\x10\x27\x20\x4e",
        b"\x01\x05\x01\x02\x03\x04\x05\x06\x07\x08\x00\xff\x00",
    ];
    let seed = |(form, text): (usize, &&[u8])| [&[form as u8, 7], *text].concat();
    texts.iter().enumerate().map(seed).collect()
}
