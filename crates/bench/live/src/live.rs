//! A sensor that is switched on, checked and read.

use std::time::{SystemTime, UNIX_EPOCH};

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use phystac::PhysTac;
use twintac_emulate::LabClock;
use twintac_recording::Provenance;
use twintac_sensor::Sensor;

use crate::{
    About, BoxedClock, FrameReader, FrameSource, Known, LiveError, TAXELS, emulated_phystac, power_on,
};

/// A sensor that is being read.
#[derive(Debug)]
pub struct Live {
    /// Its frames.
    pub source: FrameSource,
    /// What it is.
    pub about: About,
    /// What was odd when it was switched on, a sentence each.
    pub notes: Vec<String>,
}

impl Live {
    /// The emulated sensor of a description, whose text is `sensor_toml`, in real time. Its barometers count as [`emulated_board`](crate::emulated_board)
    /// says, which needs nobody to confirm it.
    ///
    /// # Errors
    /// Those of [`emulated_phystac`] and [`power_on`].
    pub fn in_the_lab(sensor: &Sensor, sensor_toml: &str, known: &Known) -> Result<Self, LiveError> {
        let start_unix_ns = unix_ns();
        let phystac = emulated_phystac(sensor, LabClock::real(), &[])?;
        let from = (Provenance::Emulated, start_unix_ns);
        let known = known.or_emulated(sensor);
        Self::begin(phystac, sensor, sensor_toml, &known, from)
    }

    /// A sensor on `/dev/i2c-N`.
    ///
    /// # Errors
    /// Those of [`open_linux`](crate::open_linux) and [`power_on`].
    #[cfg(target_os = "linux")]
    pub fn on_linux(
        path: &std::path::Path,
        sensor: &Sensor,
        sensor_toml: &str,
        known: &Known,
    ) -> Result<Self, LiveError> {
        let start_unix_ns = unix_ns();
        let settings = crate::driver_settings(sensor)?;
        let start = std::time::Instant::now();
        let clock: BoxedClock = Box::new(move || start.elapsed().as_micros() as u64); // 584 thousand years
        let phystac = crate::open_linux(path, settings, clock)?;
        let from = (Provenance::Real, start_unix_ns);
        Self::begin(phystac, sensor, sensor_toml, known, from)
    }

    fn begin<I2C: I2c + Send + 'static, D: DelayNs + Send + 'static>(
        mut phystac: PhysTac<I2C, D, BoxedClock, TAXELS>,
        sensor: &Sensor,
        sensor_toml: &str,
        known: &Known,
        (provenance, start_unix_ns): (Provenance, u64),
    ) -> Result<Self, LiveError> {
        let checked = power_on(&mut phystac, sensor, known)?;
        let reader = FrameReader::new(phystac, &checked);
        Ok(Self {
            source: FrameSource::start(reader, FrameSource::USUAL_CAPACITY)?,
            about: About::new(sensor, sensor_toml, provenance, checked.transfer, start_unix_ns),
            notes: checked.notes,
        })
    }
}

/// Wall-clock time, ns since 1970-01-01 UTC; 0 on a computer that stands before.
fn unix_ns() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    since.as_nanos() as u64 // until the year 2554
}
