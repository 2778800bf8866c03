//! The robot: its frames, its reports, and the emulated robot's answers to requests.

use glam::DVec3;
use twintac_emulate::robot::{Controller, RobotSettings};
use twintac_emulate::{Hertz, LabClock, Workcell};
use twintac_rig::xarm::{
    Answer, Client, Command, FEEDBACK, Incoming, LARGEST_FRAME_BYTES, LARGEST_REPORT_BYTES, Pair,
    RealTimeReport, Report, ReportPort, Request, report_splitter, splitter,
};
use twintac_rig::{Splitter, TcpPose};

const PORTS: [ReportPort; 3] = [ReportPort::Normal, ReportPort::Rich, ReportPort::Development];
const QUESTIONS: [Command; 7] = [
    Command::GetVersion,
    Command::GetState,
    Command::GetCommandCount,
    Command::GetErrors,
    Command::GetPose,
    Command::GetJoints,
    Command::CleanError,
];

/// Checks a stream from the robot or to it.
pub(crate) fn frames(bytes: &[u8]) {
    for frame in split_twice(splitter, LARGEST_FRAME_BYTES, bytes) {
        if let Ok(request) = Request::decode(&frame) {
            let encoded = request.encode();
            assert_eq!(Request::decode(&encoded).unwrap().encode(), encoded);
            assert!(encoded.len() <= frame.len(), "what a request says is all there");
        }
        match Incoming::decode(&frame) {
            Ok(Incoming::Response(response)) => {
                assert_eq!(response.encode(), frame);
                for command in &QUESTIONS {
                    answer(command, &response.payload);
                }
            }
            Ok(Incoming::Feedback(rest)) => assert!(frame[6] == FEEDBACK && frame.ends_with(&rest)),
            Err(_) => {}
        }
    }
    converse(bytes);
}

fn answer(command: &Command, payload: &[u8]) {
    if let Ok(answer) = Answer::decode(command, payload) {
        let encoded = answer.encode();
        assert_eq!(Answer::decode(command, &encoded).unwrap().encode(), encoded);
    }
}

/// Runs a client that receives these bytes as answers.
fn converse(bytes: &[u8]) {
    let (reader, writer) = (bytes, Vec::new());
    let mut client = Client::new(Pair { reader, writer });
    let _ = client.enable();
    let _ = client.state();
    let _ = client.errors();
    let _ = client.pose();
    let _ = client.stop();
}

/// Sends requests to the emulated robot. The transaction number is the delay after the last
/// request, in ms.
pub(crate) fn controller(bytes: &[u8]) {
    let clock = LabClock::virtual_time();
    let settings = RobotSettings::default();
    let workcell = Workcell::new(clock.clone(), Hertz::default(), settings.first_pose, settings.arm);
    let [low_mm, high_mm] = settings.reach_mm;
    let mut controller = Controller::new(workcell, settings, &[]).unwrap();
    for frame in split(splitter(), LARGEST_FRAME_BYTES, bytes, bytes.len()) {
        clock.wait_s(f64::from(frame[1] & 7) * 1e-3);
        let Some(answer) = controller.respond(&frame) else {
            continue;
        };
        let Ok(Incoming::Response(response)) = Incoming::decode(&answer) else {
            panic!("an answer that is none: {answer:02x?}");
        };
        assert_eq!(
            response.transaction.to_be_bytes(),
            frame[..2],
            "the request's number"
        );
        assert_eq!(response.function, frame[6], "the request's function");
        let TcpPose {
            position_mm,
            roll_pitch_yaw_rad,
        } = controller.pose();
        let is_reached = |at_mm: DVec3| {
            at_mm.cmpge(low_mm - 1e-6).all() && at_mm.cmple(high_mm + 1e-6).all() && at_mm.is_finite()
        };
        assert!(
            is_reached(position_mm) && roll_pitch_yaw_rad.is_finite(),
            "{position_mm} {roll_pitch_yaw_rad}"
        );
    }
    for port in PORTS {
        Report::decode(port, &controller.report_frame(port)).unwrap();
    }
}

/// Checks a stream of reports.
pub(crate) fn reports(bytes: &[u8]) {
    let split = split_twice(report_splitter, LARGEST_REPORT_BYTES, bytes);
    for frame in split.iter().map(Vec::as_slice).chain([bytes]) {
        for port in PORTS {
            if let Ok(report) = Report::decode(port, frame) {
                let encoded = report.encode(port);
                assert_eq!(Report::decode(port, &encoded).unwrap().encode(port), encoded);
            }
        }
        if let Ok(report) = RealTimeReport::decode(frame) {
            let encoded = report.encode();
            assert_eq!(RealTimeReport::decode(&encoded).unwrap().encode(), encoded);
        }
    }
}

/// The frames of a stream. They must be the same in whatever pieces it is read.
fn split_twice(splitter: fn() -> Splitter, largest: usize, bytes: &[u8]) -> Vec<Vec<u8>> {
    let frames = split(splitter(), largest, bytes, bytes.len());
    assert_eq!(split(splitter(), largest, bytes, 3), frames);
    let n_bytes: usize = frames.iter().map(Vec::len).sum();
    assert!(n_bytes <= bytes.len());
    frames
}

fn split(mut splitter: Splitter, largest: usize, bytes: &[u8], chunk_bytes: usize) -> Vec<Vec<u8>> {
    let mut frames = Vec::new();
    for mut chunk in bytes.chunks(chunk_bytes.max(1)) {
        while let Ok(Some(frame)) = splitter.take(&mut chunk) {
            assert!(frame.len() <= largest);
            frames.push(frame);
        }
        assert!(splitter.capacity() <= largest);
    }
    frames
}
