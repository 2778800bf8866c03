//! A sensor whose microcontroller writes to a serial line (here a pseudo-terminal), or sends
//! datagrams.

#![cfg(unix)]
#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::io::Write;
use std::net::UdpSocket;
use std::time::{Duration, Instant};

use glam::DVec3;
use phystac::{Chip, PhysTac, Settings, Thresholds, Wired, Wiring};
use serialport::{SerialPort, TTYPort};
use twintac_emulate::i2c::{Board, BoardSettings, PartSettings};
use twintac_emulate::robot::ArmSettings;
use twintac_emulate::{Hertz, LabClock, Workcell};
use twintac_line::{Checksum, Description};
use twintac_log::TaxelState;
use twintac_rig::TcpPose;
use twintac_source::{
    BoxedClock, FrameReader, FrameSource, LineSource, PowerOn, Reading, SerialLine, SourceError,
    TactileSource,
};

const PATIENCE: Duration = Duration::from_secs(5);

/// The two ends of a pseudo-terminal: the board's end, and the path of the computer's end.
fn terminal() -> (TTYPort, TTYPort, String) {
    let (board, computer) = TTYPort::pair().unwrap();
    let path = computer.name().unwrap();
    (board, computer, path)
}

fn clock() -> BoxedClock {
    let start = Instant::now();
    Box::new(move || start.elapsed().as_micros() as u64)
}

/// Frames of an emulated sensor of eight chips on an I²C bus, pressed by a ball.
fn frames_over_i2c(n: usize) -> Vec<Reading> {
    let clock = LabClock::virtual_time();
    let tool = TcpPose {
        position_mm: DVec3::new(200.0, 0.0, 99.0),
        roll_pitch_yaw_rad: DVec3::new(std::f64::consts::PI, 0.0, 0.0),
    };
    let workcell = Workcell::new(clock.clone(), Hertz::default(), tool, ArmSettings::default());
    let wired = [0, 1, 2, 3, 4, 5, 6, 7].map(|channel| Wired::on_channel(Chip::Bmp390, channel));
    let settings = BoardSettings {
        parts: (0..8)
            .map(|channel| PartSettings::on_channel("BMP390", channel))
            .collect(),
        ..BoardSettings::default()
    };
    let board = Board::new(workcell, &settings, &[]).unwrap();
    let now = clock.clone();
    let now: BoxedClock = Box::new(move || now.now_us());
    let phystac = PhysTac::new(
        board.bus(),
        clock,
        now,
        Settings::<8>::new(Wiring::new(&wired).unwrap()),
    );
    let checked = PowerOn {
        transfer: None,
        thresholds: Thresholds::default(),
        notes: Vec::new(),
    };
    let mut reader = FrameReader::new(phystac, &checked);
    (0..n).map(|_| reader.read().unwrap()).collect()
}

/// The line that a board would write for a frame.
fn line_of(reading: &Reading) -> String {
    let frame = &reading.frame;
    let mut cells = vec![reading.sequence.to_string(), frame.triggered_us.to_string()];
    let pressures = frame.taxels.iter().map(|taxel| taxel.pressure_pa);
    let temperatures = frame.taxels.iter().map(|taxel| taxel.temperature_c);
    cells.extend(
        pressures
            .chain(temperatures)
            .map(|number| number.map_or("nan".to_owned(), |number| number.to_string())),
    );
    let line = cells.join(",");
    format!("{line}*{:02X}\r\n", Checksum::Xor8.of(line.as_bytes()))
}

fn description() -> Description {
    let text = r#"
        form = "text"
        fields = ["sequence", "time", "pressure * 8", "temperature * 8"]
        text.checksum = "xor8"
        time.unit = "us"
        pressure.unit = "Pa"
        serial.baud = 115200
    "#;
    Description::parse("board.toml", text).unwrap()
}

#[test]
fn the_same_frames_come_over_i2c_and_over_a_serial_line() {
    let sent = frames_over_i2c(500);
    let (mut board, computer, path) = terminal();
    let line = SerialLine::open(&path, &description()).unwrap();
    let mut source = LineSource::new(line, &description(), 8, clock()).unwrap();
    let text: String = sent.iter().map(line_of).collect();
    let writer = std::thread::spawn(move || {
        board.write_all(b"ESP-ROM:esp32s3\r\n").unwrap();
        board.write_all(text.as_bytes()).unwrap();
        board
    });
    for reading in &sent {
        let heard = source.next_frame(PATIENCE).unwrap().unwrap();
        assert_eq!(heard.sequence, reading.sequence);
        let values = |reading: &Reading| -> Vec<_> {
            reading
                .frame
                .taxels
                .iter()
                .map(|taxel| (taxel.state, taxel.temperature_c))
                .collect()
        };
        assert_eq!(values(&heard), values(reading));
        for (heard, sent) in heard.frame.taxels.iter().zip(&reading.frame.taxels) {
            let (heard, sent) = (heard.pressure_pa.unwrap(), sent.pressure_pa.unwrap());
            assert!((heard - sent).abs() < 1e-9 * sent, "{heard} {sent}");
        }
    }
    assert_eq!(source.remarks(), Vec::<String>::new());
    assert_eq!(source.tally().text, 1);
    drop((writer.join().unwrap(), computer));
}

#[test]
fn times_are_those_at_which_the_board_read() {
    let (mut board, computer, path) = terminal();
    let text = "form = \"text\"\nfields = [\"time\", \"pressure\"]\ntime.unit = \"ms\"";
    let description = Description::parse("board.toml", text).unwrap();
    let line = SerialLine::open(&path, &description).unwrap();
    let mut source = LineSource::new(line, &description, 1, clock()).unwrap();
    // Lines arrive in bursts of five, as from a port that buffers its bytes.
    let writer = std::thread::spawn(move || {
        for burst in 0..20 {
            std::thread::sleep(Duration::from_millis(50));
            let lines: String = (0..5)
                .map(|line| format!("{},101.3\n", 10 * (5 * burst + line)))
                .collect();
            board.write_all(lines.as_bytes()).unwrap();
        }
        board
    });
    let times: Vec<f64> = (0..100)
        .map(|_| source.next_frame(PATIENCE).unwrap().unwrap().bench_s)
        .collect();
    let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let late: Vec<f64> = steps
        .iter()
        .copied()
        .filter(|step_s| (step_s - 0.01).abs() > 2e-3)
        .collect();
    assert!(late.len() < 10, "{steps:?}");
    drop((writer.join().unwrap(), computer));
}

#[test]
fn what_is_torn_doubled_late_or_garbage_is_marked_and_counted() {
    let sent = frames_over_i2c(60);
    let (mut board, computer, path) = terminal();
    let line = SerialLine::open(&path, &description()).unwrap();
    let mut source = LineSource::new(line, &description(), 8, clock()).unwrap();
    let mut bytes = Vec::new();
    for (index, reading) in sent.iter().enumerate() {
        let line = line_of(reading);
        match index {
            10 => bytes.extend(&line.as_bytes()[..30]), // incomplete: runs into the next line
            20 => bytes.extend([line.as_bytes(), line.as_bytes()].concat()),
            30 => {} // late: after the next one
            31 => bytes.extend([line.as_bytes(), line_of(&sent[30]).as_bytes()].concat()),
            40 => bytes.extend([b"\xFF\xFE garbage \x00\r\n", line.as_bytes()].concat()),
            50 => {} // lost
            _ => bytes.extend(line.as_bytes()),
        }
    }
    board.write_all(&bytes).unwrap();
    let mut heard = Vec::new();
    while heard.last() != Some(&59) {
        heard.push(source.next_frame(PATIENCE).unwrap().unwrap().sequence);
    }
    let missing: Vec<u64> = (0..60).filter(|number| !heard.contains(number)).collect();
    assert_eq!(missing, [10, 11, 30, 50]);
    assert!(heard.is_sorted());
    let tally = source.tally();
    assert_eq!((tally.frames, tally.lost), (56, 4));
    assert_eq!(
        (tally.checksum, tally.doubled, tally.late, tally.text),
        (1, 1, 1, 1)
    );
    assert!(
        source.remarks().contains(&"missing frames: 4".to_owned()),
        "{:?}",
        source.remarks()
    );
    drop((board, computer));
}

#[test]
fn a_port_that_says_something_else_says_what() {
    let (mut board, computer, path) = terminal();
    let line = SerialLine::open(&path, &description()).unwrap();
    let source = LineSource::new(line, &description(), 8, clock()).unwrap();
    let mut source = FrameSource::start(source, 16).unwrap();
    board
        .write_all(b"please press a key\r\nplease press a key\r\n")
        .unwrap();
    let error = loop {
        match source.next(Duration::from_millis(200)) {
            Ok(reading) => assert_eq!(reading, None),
            Err(error) => break error.to_string(),
        }
    };
    assert!(
        error.contains("none came for 3 s; 2 lines were received, none with readings as described"),
        "{error}"
    );
    drop((board, computer));
}

#[test]
fn a_port_that_is_not_there_is_named_and_so_are_wrong_numbers_of_taxels() {
    let error = SerialLine::open("/dev/ttyNONE7", &description()).unwrap_err();
    assert!(error.to_string().contains("/dev/ttyNONE7"), "{error}");
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let error = LineSource::new(socket, &description(), 7, clock()).unwrap_err();
    assert!(matches!(error, SourceError::Taxels { .. }), "{error}");
}

#[test]
fn datagrams_are_read_as_lines() {
    let sent = frames_over_i2c(100);
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let address = socket.local_addr().unwrap();
    let mut source = LineSource::new(socket, &description(), 8, clock()).unwrap();
    let board = UdpSocket::bind("127.0.0.1:0").unwrap();
    for reading in &sent {
        board.send_to(line_of(reading).as_bytes(), address).unwrap();
        let heard = source.next_frame(PATIENCE).unwrap().unwrap();
        assert_eq!(heard.sequence, reading.sequence);
        assert!(
            heard
                .frame
                .taxels
                .iter()
                .all(|taxel| taxel.state == TaxelState::Good)
        );
    }
    assert_eq!(source.next_frame(Duration::from_millis(20)).unwrap(), None);
}
