//! A user's board, from its serial port to rows, to a log and to a data sheet of its sensor. The
//! board is emulated; its firmware and the protocol are the real ones.

#![cfg(unix)]
#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

use phystac::Chip;
use serialport::{SerialPort, TTYPort};
use twintac_emulate::{FaultKind, Hertz, LabClock, Moment, ScheduledFault};
use twintac_microcontroller::{Microcontroller, N_TAXELS, Setup};

/// The taxel that disappears, and when, s on the board's clock.
const AWAY: usize = 3;
const AWAY_S: [f64; 2] = [1.0, 1.5];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

fn twintac(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_twintac"))
        .args(arguments)
        .output()
        .unwrap()
}

fn data(output: &Output) -> String {
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// PhysTac with the board's kind of barometers.
fn sensor(folder: &Path) -> String {
    let paper = std::fs::read_to_string(root().join("sensors/phystac.toml")).unwrap();
    let path = folder.join("my-phystac.toml");
    let own = paper
        .replace("CPS135B", "MS5837-30BA")
        .replace("min_kpa = 50.0", "min_kpa = 0.0")
        .replace("max_kpa = 1500.0", "max_kpa = 3000.0")
        .replace("resolution_kpa = 0.01", "resolution_kpa = 0.02");
    std::fs::write(&path, own).unwrap();
    path.to_str().unwrap().to_owned()
}

/// A board on a pseudo-terminal, in a thread of its own, until it is unplugged. One of its chips
/// disappears for a while.
struct Plugged {
    port: String,
    is_unplugged: Arc<AtomicBool>,
    board: JoinHandle<()>,
    _computer: TTYPort, // keeps the port alive while no program has it open
}

fn plug() -> Plugged {
    let (mut wire, computer) = TTYPort::pair().unwrap();
    let port = computer.name().unwrap();
    let is_unplugged = Arc::new(AtomicBool::new(false));
    let ends = Arc::clone(&is_unplugged);
    let board = thread::spawn(move || {
        let mut setup = Setup::of(Chip::Ms5837_30Ba);
        setup.faults = vec![ScheduledFault {
            what: FaultKind::NoAcknowledge {
                channel: Some(AWAY as u8),
            },
            begins: Moment::TimeS(AWAY_S[0]),
            lasts: Some(Moment::TimeS(AWAY_S[1] - AWAY_S[0])),
        }];
        // It starts when the reading program has sent a request.
        let mut heard = [0; 256];
        while !ends.load(Ordering::Relaxed) && wire.bytes_to_read().unwrap() == 0 {
            thread::yield_now();
        }
        let mut board = Microcontroller::new(LabClock::real(), Hertz::default(), &setup).unwrap();
        while !ends.load(Ordering::Relaxed) {
            if wire.bytes_to_read().unwrap() > 0 {
                let n = wire.read(&mut heard).unwrap();
                board.hear(&heard[..n]);
            }
            let (_, bytes) = board.round();
            let mut rest = bytes.as_slice();
            while !rest.is_empty() && !ends.load(Ordering::Relaxed) {
                match wire.write(rest) {
                    Ok(n) => rest = &rest[n..],
                    Err(error) => assert_eq!(error.kind(), ErrorKind::TimedOut, "{error}"),
                }
            }
        }
    });
    Plugged {
        port,
        is_unplugged,
        board,
        _computer: computer,
    }
}

impl Plugged {
    fn unplug(self) {
        self.is_unplugged.store(true, Ordering::Relaxed);
        self.board.join().unwrap();
    }
}

/// The output of `stream` for three seconds of a board.
fn stream(board: &Plugged, line: &Path, sensor: &str, to: [&str; 2]) -> String {
    let line = line.to_str().unwrap();
    let from = [
        "stream",
        "--serial",
        &board.port,
        "--line",
        line,
        "--sensor",
        sensor,
        "--seconds",
        "3",
    ];
    data(&twintac(&[&from[..], &to].concat()))
}

#[test]
fn rows_are_what_the_board_sends_and_mark_what_it_could_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let sensor = sensor(folder.path());
    for line in ["csv-8.toml", "packets-8.toml"] {
        let line = root().join("firmware/lines").join(line);
        let board = plug();
        let rows = stream(&board, &line, &sensor, ["--format", "csv"]);
        board.unplug();
        let mut table = rows.lines().map(|row| row.split(',').collect::<Vec<_>>());
        let names = table.next().unwrap();
        let column = |name: &str| names.iter().position(|of| *of == name).unwrap();
        let rows: Vec<Vec<&str>> = table.collect();
        assert!(
            (300..480).contains(&rows.len()),
            "152 a second at most: {}",
            rows.len()
        );
        for (index, row) in rows.iter().enumerate() {
            assert_eq!(row[column("seq")], index.to_string(), "{row:?}");
            for taxel in 0..N_TAXELS {
                let is_read = !row[column(&format!("t{taxel}_above_tare_kpa"))].is_empty();
                let is_fault = !row[column(&format!("t{taxel}_fault"))].is_empty();
                assert!(is_read != is_fault && (is_read || taxel == AWAY), "{row:?}");
            }
        }
        let is_away = |row: &&Vec<&str>| row[column("t3_above_tare_kpa")].is_empty();
        let n_away = rows.iter().filter(is_away).count();
        assert!(
            (50..100).contains(&n_away),
            "half a second of 152 a second: {n_away}"
        );
    }
}

#[test]
fn a_log_of_the_board_at_rest_makes_a_sheet_of_its_sensor() {
    let folder = tempfile::tempdir().unwrap();
    let sensor = sensor(folder.path());
    let log = folder.path().join("rest.mcap");
    let out = folder.path().join("sheet");
    let line = root().join("firmware/lines/csv-8.toml");
    let board = plug();
    stream(&board, &line, &sensor, ["--log", log.to_str().unwrap()]);
    board.unplug();
    data(&twintac(&[
        "characterize",
        "--sensor",
        &sensor,
        "--recordings",
        log.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
    ]));
    let found = std::fs::read_to_string(out.join("characterization.json")).unwrap();
    let found: serde_json::Value = serde_json::from_str(&found).unwrap();
    let fates: Vec<&serde_json::Value> = { found["conditions"].as_array().unwrap().iter() }
        .map(|taxel| &taxel["fate"])
        .collect();
    for (taxel, fate) in fates.iter().enumerate() {
        let right = if taxel == AWAY { "intermittent" } else { "fine" };
        assert_eq!(**fate, right, "t{taxel}: {found}");
    }
}
