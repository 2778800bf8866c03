//! The emulated sensor in virtual time.

#![allow(dead_code, unreachable_pub)] // each test file uses its own part

use phystac::{Thresholds, Transfer};
use twintac_emulate::i2c::Bus;
use twintac_emulate::{FaultKind, LabClock, Moment, ScheduledFault};
use twintac_live::{About, EmulatedPhysTac, emulated_phystac};
use twintac_recording::Provenance;
use twintac_sensor::Sensor;
use twintac_source::{BoxedClock, FrameReader, Known, PowerOn, TAXELS, power_on};

pub type LabReader = FrameReader<Bus, LabClock, BoxedClock, TAXELS>;

pub fn sensor() -> Sensor {
    Sensor::read("../../../sensors/phystac.toml").unwrap()
}

pub fn phystac(faults: &[ScheduledFault]) -> EmulatedPhysTac {
    emulated_phystac(&sensor(), LabClock::virtual_time(), faults).unwrap()
}

pub fn reader(faults: &[ScheduledFault]) -> (LabReader, About) {
    let mut phystac = phystac(faults);
    let checked = power_on(&mut phystac, &sensor(), &scale(8)).unwrap();
    let about = About::new(
        &sensor(),
        "name = \"phystac\"",
        Provenance::Emulated,
        checked.transfer,
        0,
    );
    (FrameReader::new(phystac, &checked), about)
}

/// The scale, as a person who knows it would give it.
pub fn scale(counts_per_pa: u16) -> Known {
    Known {
        counts_per_pa: Some(counts_per_pa),
        ..Known::default()
    }
}

/// A sensor that was switched on with this conversion, whatever its range.
pub fn checked(transfer: Transfer) -> PowerOn {
    PowerOn {
        transfer: Some(transfer),
        thresholds: Thresholds::default(),
        notes: Vec::new(),
    }
}

/// A barometer that does not respond from a time on, s.
pub fn gone(channel: u8, from_s: f64) -> ScheduledFault {
    ScheduledFault {
        what: FaultKind::NoAcknowledge {
            channel: Some(channel),
        },
        begins: Moment::TimeS(from_s),
        lasts: None,
    }
}
