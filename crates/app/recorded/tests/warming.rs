//! Drift of zeros with temperature, on the emulated bus: how much of it one log shows, and how much
//! compensation removes from later readings.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::path::{Path, PathBuf};

use glam::DVec3;
use phystac::PhysTac;
use twintac_emulate::i2c::{Board, Bus};
use twintac_emulate::robot::ArmSettings;
use twintac_emulate::{LabClock, MOST_TAXELS, Physics, Sensed, Workcell};
use twintac_live::{About, Taring, emulated_board};
use twintac_log::{Body, LogFile, LogWriter, Message};
use twintac_recorded::{COMPENSATION, Recorded};
use twintac_recording::Provenance;
use twintac_rig::TcpPose;
use twintac_sensor::SensorFile;
use twintac_source::{BoxedClock, FrameReader, Known, Reading, TAXELS, driver_settings, power_on};
use twintac_temperature::Compensation;
use twintac_work::Silent;

/// Time between frames, s.
const STEP_S: f64 = 0.2;

/// Frames per second.
const FRAMES: u32 = 5;

/// Temperature coefficient of each taxel's zero, kPa/K. The largest makes 8 kPa of 4 K.
const KPA_PER_K: [f64; 8] = [2.0, 0.5, -0.3, 0.0, 1.1, -1.7, 0.05, 0.9];

/// The chips warm up, and nothing touches the sensor.
#[derive(Clone, Copy)]
struct Warming {
    start_c: f64,
    /// The rise of temperature at the end, K.
    by_k: f64,
    time_s: f64,
}

impl Warming {
    fn warmed_k(self, time_s: f64) -> f64 {
        -self.by_k * (-time_s / self.time_s).exp_m1()
    }
}

impl Physics for Warming {
    fn at(&mut self, _: &TcpPose, time_s: f64) -> Sensed {
        let warmed_k = self.warmed_k(time_s);
        let mut taxel_pressures_kpa = [101.325; MOST_TAXELS];
        for (pressure_kpa, kpa_per_k) in taxel_pressures_kpa.iter_mut().zip(KPA_PER_K) {
            *pressure_kpa += kpa_per_k * (self.start_c - 25.0 + warmed_k);
        }
        Sensed {
            taxel_pressures_kpa,
            ..Sensed::untouched(101.325, self.start_c + warmed_k)
        }
    }
}

/// A sensor on the emulated bus that warms up, read frame by frame.
struct Desk {
    reader: FrameReader<Bus, LabClock, BoxedClock, TAXELS>,
    clock: LabClock,
    /// When the next frame is due, s.
    due_s: f64,
    about: About,
}

impl Desk {
    fn new(warming: Warming) -> Self {
        let file = SensorFile::phystac().unwrap();
        let sensor = &file.sensor;
        let clock = LabClock::virtual_time();
        let nowhere = TcpPose {
            position_mm: DVec3::ZERO,
            roll_pitch_yaw_rad: DVec3::ZERO,
        };
        let workcell = Workcell::new(clock.clone(), warming, nowhere, ArmSettings::default());
        let board = Board::new(workcell, &emulated_board(sensor), &[]).unwrap();
        let now = clock.clone();
        let now: BoxedClock = Box::new(move || now.now_us());
        let settings = driver_settings(sensor).unwrap();
        let mut phystac = PhysTac::new(board.bus(), clock.clone(), now, settings);
        let known = Known::default().or_emulated(sensor);
        let checked = power_on(&mut phystac, sensor, &known).unwrap();
        let about = About::new(sensor, &file.text, Provenance::Emulated, checked.transfer, 0);
        Self {
            reader: FrameReader::new(phystac, &checked),
            due_s: clock.now_s(),
            clock,
            about,
        }
    }

    fn read(&mut self) -> Reading {
        self.clock.wait_s((self.due_s - self.clock.now_s()).max(0.0));
        self.due_s += STEP_S;
        self.reader.read().unwrap()
    }

    /// Writes a log of this many minutes.
    fn log(mut self, file: &Path, minutes: u32) {
        let mut log = LogWriter::new(LogFile::create(file).unwrap(), &self.about.description()).unwrap();
        for _ in 0..minutes * 60 * FRAMES {
            let reading = self.read();
            log.write(&Message::at_s(reading.bench_s, Body::Tactile(reading.frame)))
                .unwrap();
        }
        log.finish().unwrap();
    }
}

/// Characterizes a log without presses, and returns the coefficients that were found.
fn characterized(log: PathBuf, folder: &Path) -> Compensation {
    let sensor = SensorFile::phystac().unwrap().sensor;
    let recorded = Recorded::read(&[log], None, &Silent).unwrap();
    assert!(recorded.recording.presses.is_empty());
    let found = recorded.characterize(&sensor).unwrap();
    assert_eq!((found.n_presses, found.n_leaps), (0, 0));
    recorded.write(&found, &sensor, folder).unwrap();
    assert!(
        std::fs::read_to_string(folder.join("report.html"))
            .unwrap()
            .contains("readings alone")
    );
    Compensation::read(&folder.join(COMPENSATION)).unwrap()
}

#[test]
fn zeros_that_drift_by_eight_kpa_an_hour_are_compensated_to_a_twentieth_of_a_kpa() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("warming.mcap");
    let warming = Warming {
        start_c: 22.0,
        by_k: 5.0,
        time_s: 600.0,
    };
    Desk::new(warming).log(&log, 30);
    let compensation = characterized(log, folder.path());
    assert_eq!(compensation.provenance, Provenance::Emulated);
    for (found, true_kpa_per_k) in compensation.taxels.iter().zip(KPA_PER_K) {
        let off = (found.kpa_per_k - true_kpa_per_k).abs();
        assert!(
            off < 0.005 && found.remaining_kpa < 0.02,
            "{found:?}, truly {true_kpa_per_k}"
        );
    }

    // Another day, with another course of temperature: 4 K in an hour, linearly.
    let later = Warming {
        start_c: 24.0,
        by_k: 400.0,
        time_s: 360_000.0,
    };
    let mut desk = Desk::new(later);
    let about = &desk.about;
    let kpa_per_k = compensation.coefficients(&about.sensor, &about.taxels).unwrap();
    let mut taring = [Taring::new(kpa_per_k), Taring::default()];
    let mut tares = loop {
        let reading = desk.read();
        let taken = taring.each_mut().map(|taring| taring.push(&reading));
        if let [Some(with), Some(without)] = taken {
            break [with, without];
        }
    };
    let mut worst_kpa = [0.0_f64; 2];
    for _ in 0..3600 {
        // Single readings are noisy; the mean of a second shows the drift.
        let mut means_kpa = [[0.0; 8]; 2];
        for _ in 0..FRAMES {
            let reading = desk.read();
            for (tare, means_kpa) in tares.iter_mut().zip(&mut means_kpa) {
                for (mean_kpa, above_kpa) in means_kpa.iter_mut().zip(tare.above_kpa(&reading)) {
                    *mean_kpa += above_kpa.unwrap() / f64::from(FRAMES);
                }
            }
        }
        for (worst_kpa, means_kpa) in worst_kpa.iter_mut().zip(means_kpa) {
            *worst_kpa = means_kpa
                .iter()
                .fold(*worst_kpa, |worst, kpa| worst.max(kpa.abs()));
        }
    }
    let [with_kpa, without_kpa] = worst_kpa;
    assert!(without_kpa > 7.5, "{without_kpa}");
    assert!(with_kpa < 0.05, "{with_kpa}");
    let [with, without] = tares;
    assert_eq!(with.remark(), None);
    let remark = without.remark().unwrap();
    assert!(
        remark.contains("4.0 K warmer") && remark.contains("--temperature"),
        "{remark}"
    );
}
