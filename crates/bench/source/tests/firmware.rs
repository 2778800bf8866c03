//! An emulated microcontroller runs the firmware and is read over a pseudo-terminal, with faults on
//! its bus and bytes lost on the line.

#![cfg(unix)]
#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::io::{ErrorKind, Read, Write};
use std::path::Path;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use phystac::{Budget, Chip};
use serialport::{SerialPort, TTYPort};
use twintac_emulate::{FaultKind, Hertz, LabClock, Moment, ScheduledFault};
use twintac_firmware::{Report, Trouble};
use twintac_line::Description;
use twintac_log::TaxelState;
use twintac_microcontroller::{Microcontroller, N_TAXELS, Setup};
use twintac_source::{LineSource, Reading, SerialLine, TactileSource};

/// How long the board runs, s of its clock, which is virtual.
const RUN_S: f64 = 4.0;
const PATIENCE: Duration = Duration::from_secs(10);

/// What the board sent, and what the line lost of it.
struct Sent {
    reports: Vec<Report<N_TAXELS>>,
    lost: Vec<u32>,
}

fn setup() -> Setup {
    let mut setup = Setup::of(Chip::Ms5837_30Ba);
    setup.faults = vec![
        ScheduledFault {
            what: FaultKind::NoAcknowledge { channel: Some(3) },
            begins: Moment::TimeS(1.0),
            lasts: Some(Moment::TimeS(0.5)),
        },
        ScheduledFault {
            what: FaultKind::StuckBus { channel: None },
            begins: Moment::TimeS(2.0),
            lasts: None,
        },
    ];
    setup
}

/// The board, on a separate thread, which starts when it has heard the `n_commands` bytes that the
/// computer sends first: what it sends before is in another form. The line loses ten bytes of every
/// hundredth frame.
fn run(mut port: TTYPort, n_commands: usize) -> JoinHandle<Sent> {
    thread::spawn(move || {
        let mut board = Microcontroller::new(LabClock::virtual_time(), Hertz::default(), &setup()).unwrap();
        let (mut reports, mut lost) = (Vec::new(), Vec::new());
        let mut commands = vec![0; n_commands];
        port.set_timeout(PATIENCE).unwrap();
        port.read_exact(&mut commands).unwrap();
        board.hear(&commands);
        while board.clock().now_s() < RUN_S {
            let (report, mut bytes) = board.round();
            reports.push(report);
            if report.sequence % 100 == 99 {
                let from = bytes.len() / 2;
                bytes.drain(from..from + 10);
                lost.push(report.sequence);
            }
            let mut rest = bytes.as_slice();
            while !rest.is_empty() {
                match port.write(rest) {
                    Ok(n) => rest = &rest[n..],
                    Err(error) => assert_eq!(error.kind(), ErrorKind::TimedOut, "{error}"),
                }
            }
        }
        // The port stays open until what was written has been read.
        thread::sleep(Duration::from_secs(1));
        Sent { reports, lost }
    })
}

fn read(line: &str) -> (Vec<Reading>, LineSource, Sent) {
    let (board, computer) = TTYPort::pair().unwrap();
    let path = computer.name().unwrap();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../firmware/lines");
    let description = Description::read(folder.join(line)).unwrap();
    let start = Instant::now();
    let clock = Box::new(move || start.elapsed().as_micros() as u64);
    let port = SerialLine::open(&path, &description).unwrap();
    let mut source = LineSource::new(port, &description, N_TAXELS, clock).unwrap();
    let board = run(board, description.serial.send.len());
    let mut readings = Vec::new();
    while !board.is_finished() {
        match source.next_frame(Duration::from_millis(100)) {
            Ok(reading) => readings.extend(reading),
            Err(_) => break, // the board is gone
        }
        assert!(start.elapsed() < 6 * PATIENCE, "the board does not end");
    }
    let sent = board.join().unwrap();
    drop(computer);
    (readings, source, sent)
}

#[test]
fn frames_are_what_the_firmware_read_and_what_it_could_not_read_is_marked() {
    for line in ["packets-8.toml", "csv-8.toml"] {
        let (readings, source, sent) = read(line);
        let (mut n_missing, mut n_failed) = (0, 0);
        let mut next = 0;
        for reading in &readings {
            next = reading.sequence + 1;
            let report = &sent.reports[usize::try_from(reading.sequence).unwrap()];
            for (taxel, said) in reading.frame.taxels.iter().zip(&report.taxels) {
                assert_eq!(taxel.state, said.state);
                assert_eq!(taxel.pressure_pa.is_some(), said.state == TaxelState::Good);
                if let (Some(heard_pa), Some(said_pa)) = (taxel.pressure_pa, said.pressure_pa) {
                    assert!(
                        (heard_pa - f64::from(said_pa)).abs() < 0.0051,
                        "{heard_pa} {said_pa}"
                    );
                    assert!(
                        (100e3..115e3).contains(&heard_pa),
                        "{heard_pa} is what the chips feel"
                    );
                }
            }
            n_missing += usize::from(reading.frame.taxels[3].state == TaxelState::Missing);
            n_failed += usize::from(report.trouble == Trouble::BusHung);
            if report.trouble == Trouble::BusHung {
                assert!(
                    reading
                        .frame
                        .taxels
                        .iter()
                        .all(|taxel| taxel.state == TaxelState::BusError)
                );
            }
        }
        let last = sent.reports.last().unwrap();
        assert_eq!(
            next,
            u64::from(last.sequence) + 1,
            "{line}: all was heard to the end"
        );
        assert!(last.rescues >= 1 && last.taxels.iter().all(|taxel| taxel.state == TaxelState::Good));
        assert!(
            n_missing > 50 && (1..=3).contains(&n_failed),
            "{n_missing} {n_failed}"
        );
        // Only what the line lost is missing, and it is counted.
        let tally = source.tally();
        let heard: Vec<u64> = readings.iter().map(|reading| reading.sequence).collect();
        assert!(
            sent.lost.len() >= 4
                && sent
                    .lost
                    .iter()
                    .all(|number| !heard.contains(&u64::from(*number)))
        );
        assert_eq!(tally.lost, sent.lost.len() as u64, "{line}: {tally:?}");
        assert_eq!(heard.len() + sent.lost.len(), sent.reports.len(), "{line}");
        // The rate is the expected one.
        let budget_hz = f64::from(Budget::new(&setup().node.sensor, 400_000).rate_hz());
        let found_hz = sent.reports.len() as f64 / RUN_S;
        println!(
            "{line}: {found_hz:.1} Hz of {budget_hz:.1}, {} lost, {tally:?}",
            sent.lost.len()
        );
        assert!(
            (0.93..1.01).contains(&(found_hz / budget_hz)),
            "{found_hz} {budget_hz}"
        );
    }
}
