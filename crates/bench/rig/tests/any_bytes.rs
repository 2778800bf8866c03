//! For any bytes: decoders return a value or an error. They never panic, and never hold more memory
//! than their bounds.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use proptest::prelude::*;
use twintac_rig::netft::{self, Configuration, Record, SequenceTracker};
use twintac_rig::xarm::{self, Answer, Command, Incoming, RealTimeReport, Report, ReportPort};
use twintac_rig::{AnalogCalibration, BenchClock, Replay, Splitter, Wrench, WrenchSource};

const PORTS: [ReportPort; 3] = [ReportPort::Normal, ReportPort::Rich, ReportPort::Development];

/// Valid frames, which the tests damage.
fn frames() -> Vec<Vec<u8>> {
    let report = Report::decode(
        ReportPort::Development,
        &[vec![0, 0, 0, 87], vec![0; 83]].concat(),
    )
    .unwrap();
    let mut frames: Vec<Vec<u8>> = [
        Command::GetVersion,
        Command::GetState,
        Command::GetErrors,
        Command::GetPose,
    ]
    .into_iter()
    .map(|command| {
        let request = xarm::Request {
            transaction: 1,
            protocol: xarm::PROTOCOL,
            command,
        };
        request.encode()
    })
    .collect();
    frames.extend(PORTS.map(|port| report.encode(port)));
    let record = Record {
        rdt_sequence: 1,
        ft_sequence: 2,
        status: netft::Status::HEALTHY,
        counts: [1, 2, 3, 4, 5, 6],
    };
    frames.push(netft::encode_records(&[record; 3]));
    frames
}

/// Random bytes, or a valid frame with some bytes changed, cut off or duplicated.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    let broken = (
        prop::sample::select(frames()),
        prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4),
        0..1000_usize,
        1..3_usize,
    );
    prop_oneof![
        prop::collection::vec(any::<u8>(), 0..1200),
        broken.prop_map(|(mut frame, changes, length, times)| {
            for (place, byte) in changes {
                let place = place.index(frame.len());
                frame[place] = byte;
            }
            frame.truncate(length);
            frame.repeat(times)
        }),
    ]
}

const PAGE: &str = "<?xml version=\"1.0\"?>\n<netFTApi><prodname>Net F/T</prodname><cfgcpf>1000000</cfgcpf>\
    <cfgcpt>1000000</cfgcpt><scfgfu>N</scfgfu><scfgtu>Nm</scfgtu></netFTApi>";
const CAL: &str = "<FTSensor><Calibration ForceUnits=\"N\" TorqueUnits=\"N-m\">\
    <UserAxis Name=\"Fx\" values=\"1 2 3 4 5 6\"/><UserAxis Name=\"Fy\" values=\"1 2 3 4 5 6\"/>\
    <UserAxis Name=\"Fz\" values=\"1 2 3 4 5 6\"/><UserAxis Name=\"Tx\" values=\"1 2 3 4 5 6\"/>\
    <UserAxis Name=\"Ty\" values=\"1 2 3 4 5 6\"/><UserAxis Name=\"Tz\" values=\"1 2 3 4 5 6\"/></Calibration></FTSensor>";
const TOML: &str = "range_v = 10.0\nbias_v = [0, 0, 0, 0, 0, 0.5]\nmatrix = [[1, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0],\
    [0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, 0, 0, 0, 1]]\n";
const CSV: &str = "time_s,fx_n,fy_n,fz_n,tx_n_mm,ty_n_mm,tz_n_mm\n0.0,1,2,3,4,5,6\n0.1,-1,-2,-3,4e2,5,6\n";

/// A valid text with some pieces replaced by others, or cut off.
fn broken(right: &'static str) -> impl Strategy<Value = String> {
    let piece = prop_oneof![
        "\\PC{0,4}",
        prop::sample::select(vec![
            "<",
            ">",
            "&",
            "\"",
            "nan",
            "1e999",
            "-1",
            "0",
            ",",
            "\n",
            "[",
            "]",
            "=",
            "<!DOCTYPE x>",
            "&#0;"
        ])
        .prop_map(str::to_owned),
    ];
    let changes = prop::collection::vec((0.0..1.0_f64, 0..8_usize, piece), 0..4);
    (changes, prop_oneof![9 => Just(1.0), 1 => 0.0..1.0_f64]).prop_map(|(changes, part)| {
        let mut text: Vec<char> = right.chars().collect();
        for (place, length, piece) in changes {
            let from = (place * text.len() as f64) as usize;
            let to = (from + length).min(text.len());
            text.splice(from..to, piece.chars());
        }
        text.truncate((part * text.len() as f64) as usize);
        text.into_iter().collect()
    })
}

fn split(mut splitter: Splitter, stream: &[u8], chunk_bytes: usize, largest: usize) -> usize {
    let mut split = 0;
    for mut chunk in stream.chunks(chunk_bytes) {
        while let Ok(Some(frame)) = splitter.take(&mut chunk) {
            assert!(frame.len() <= largest && frame.capacity() <= largest);
            split += frame.len();
        }
        assert!(splitter.capacity() <= largest);
    }
    split
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn streams_split_the_same_however_they_are_read(stream in bytes(), chunk_bytes in 1..300_usize) {
        for (splitter, largest) in [
            (xarm::splitter as fn() -> Splitter, xarm::LARGEST_FRAME_BYTES),
            (xarm::report_splitter, xarm::LARGEST_REPORT_BYTES),
        ] {
            let in_pieces = split(splitter(), &stream, chunk_bytes, largest);
            prop_assert_eq!(in_pieces, split(splitter(), &stream, stream.len().max(1), largest));
            prop_assert!(in_pieces <= stream.len());
        }
    }

    #[test]
    fn robot_frames_are_read_or_refused(frame in bytes(), function in any::<u8>()) {
        if let Ok(request) = xarm::Request::decode(&frame) {
            prop_assert!(xarm::Request::decode(&request.encode()).is_ok());
        }
        if let Ok(Incoming::Response(response)) = Incoming::decode(&frame) {
            prop_assert_eq!(response.encode(), frame.clone());
        }
        if let Ok(command) = Command::decode(function, &frame) {
            let _ = Answer::decode(&command, &frame);
        }
        let _ = Answer::decode(&Command::GetPose, &frame);
        let _ = Answer::decode(&Command::GetVersion, &frame);
    }

    #[test]
    fn reports_are_read_or_refused(frame in bytes()) {
        for port in PORTS {
            if let Ok(report) = Report::decode(port, &frame) {
                prop_assert!(Report::decode(port, &report.encode(port)).is_ok());
            }
        }
        let _ = RealTimeReport::decode(&frame);
    }

    #[test]
    fn force_sensor_datagrams_are_read_or_refused(datagram in bytes()) {
        let _ = netft::Request::decode(&datagram);
        let mut tracker = SequenceTracker::default();
        let mut n_records = 0;
        if let Ok(records) = netft::decode_records(&datagram) {
            let records: Vec<Record> = records.collect();
            prop_assert!(netft::encode_records(&records) == datagram);
            for record in &records {
                prop_assert!(tracker.track(record).time_s.is_finite());
                let _ = record.status.to_string();
            }
            n_records = records.len() as u64;
        }
        let report = tracker.report();
        prop_assert_eq!(report.received + report.doubled, n_records);
    }

    #[test]
    fn configuration_pages_are_read_or_refused(page in broken(PAGE)) {
        if let Ok(configuration) = Configuration::parse("page", &page) {
            let wrench = configuration.wrench([1, -1, i32::MIN, i32::MAX, 0, 1]);
            prop_assert!(!wrench.force_n.is_nan() && !wrench.torque_n_mm.is_nan());
            prop_assert!(Configuration::parse("page", &configuration.to_xml()).is_ok());
        }
    }

    #[test]
    fn calibrations_are_read_or_refused(cal in broken(CAL), toml in broken(TOML)) {
        for calibration in [
            AnalogCalibration::parse_cal("FT.cal", &cal).ok(),
            AnalogCalibration::parse_toml("cal.toml", &toml).ok(),
        ].into_iter().flatten() {
            prop_assert!(calibration.matrix.iter().flatten().all(|number| number.is_finite()));
            let _ = calibration.wrench([1.0; 6]);
        }
    }

    #[test]
    fn replayed_files_are_read_or_refused(file in broken(CSV)) {
        if let Ok(rows) = Replay::rows("file.csv", &file) {
            prop_assert!(rows.windows(2).all(|pair| pair[1].0 > pair[0].0));
        }
    }

    #[test]
    fn replays_play_whatever_was_recorded(times in prop::collection::btree_set(-1_000_000_000..1_000_000_000_i64, 0..4)) {
        let rows = times.iter().map(|time| (*time as f64 * 1e-9, Wrench::ZERO)).collect();
        let mut replay = Replay::new(rows, BenchClock::start());
        for _ in 0..5 {
            prop_assert!(replay.next_sample(std::time::Duration::ZERO).is_ok());
        }
    }
}
