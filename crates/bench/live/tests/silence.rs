//! A hung bus: it gives neither frames nor errors.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod common;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use common::sensor;
use embedded_hal::i2c::{ErrorType, I2c, Operation};
use glam::DVec3;
use phystac::PhysTac;
use twintac_emulate::i2c::{Board, BoardSettings, Bus};
use twintac_emulate::robot::ArmSettings;
use twintac_emulate::{LabClock, Physics, Sensed, Workcell};
use twintac_rig::TcpPose;
use twintac_source::{BoxedClock, FrameReader, FrameSource, Known, SourceError, driver_settings, power_on};

/// Free air.
struct Air;

impl Physics for Air {
    fn at(&mut self, _: &TcpPose, _: f64) -> Sensed {
        Sensed::untouched(101.325, 25.0)
    }
}

/// A bus on which a transaction takes ten seconds while it hangs.
struct Hanging {
    bus: Bus,
    hangs: Arc<AtomicBool>,
}

impl ErrorType for Hanging {
    type Error = <Bus as ErrorType>::Error;
}

impl I2c for Hanging {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), Self::Error> {
        if self.hangs.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_secs(10));
        }
        self.bus.transaction(address, operations)
    }
}

#[test]
fn a_bus_that_hangs_is_given_up_after_three_seconds_and_left_behind() {
    let clock = LabClock::real();
    let nowhere = TcpPose {
        position_mm: DVec3::ZERO,
        roll_pitch_yaw_rad: DVec3::ZERO,
    };
    let workcell = Workcell::new(clock.clone(), Air, nowhere, ArmSettings::default());
    let settings = BoardSettings::default();
    let known = Known {
        counts_per_pa: Some(settings.barometer.counts_per_pa as u16),
        ..Known::default()
    };
    let hangs = Arc::new(AtomicBool::new(false));
    let bus = Hanging {
        bus: Board::new(workcell, &settings, &[]).unwrap().bus(),
        hangs: Arc::clone(&hangs),
    };
    let now = clock.clone();
    let now: BoxedClock = Box::new(move || now.now_us());
    let mut phystac = PhysTac::new(bus, clock, now, driver_settings(&sensor()).unwrap());
    let checked = power_on(&mut phystac, &sensor(), &known).unwrap();
    let reader = FrameReader::new(phystac, &checked);
    let mut source = FrameSource::start(reader, FrameSource::USUAL_CAPACITY).unwrap();
    assert!(source.next(Duration::from_secs(1)).unwrap().is_some());

    hangs.store(true, Ordering::Relaxed);
    let start = Instant::now();
    let error = loop {
        if let Err(error) = source.next(Duration::from_millis(50)) {
            break error;
        }
    };
    let waited = start.elapsed();
    assert!(
        matches!(&error, SourceError::Wire { problem } if problem.contains("3 s")),
        "{error}"
    );
    assert!(
        waited > Duration::from_secs(2) && waited < Duration::from_secs(8),
        "{waited:?}"
    );

    let start = Instant::now();
    drop(source);
    assert!(start.elapsed() < Duration::from_secs(8), "{:?}", start.elapsed());
}
