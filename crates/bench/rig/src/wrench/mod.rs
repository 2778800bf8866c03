//! Sources of forces and torques.

mod analog;
mod calibration;
mod calibration_file;
mod netft;
mod replay;

use std::time::Duration;

use glam::DVec3;
use serde::{Deserialize, Serialize};

pub use analog::{Analog, VoltageSample};
pub use calibration::AnalogCalibration;
pub use netft::NetFtSource;
pub use replay::Replay;

use crate::{RigError, Stamp};

/// Force and torque on the sensor, in the sensor's frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wrench {
    /// Force, N.
    pub force_n: DVec3,
    /// Torque about the sensor's origin, N mm.
    pub torque_n_mm: DVec3,
}

impl Wrench {
    /// No load.
    pub const ZERO: Self = Self {
        force_n: DVec3::ZERO,
        torque_n_mm: DVec3::ZERO,
    };

    /// From Fx, Fy, Fz in N and Tx, Ty, Tz in N mm.
    #[must_use]
    pub fn from_axes([fx, fy, fz, tx, ty, tz]: [f64; 6]) -> Self {
        Self {
            force_n: DVec3::new(fx, fy, fz),
            torque_n_mm: DVec3::new(tx, ty, tz),
        }
    }
}

/// One reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrenchSample {
    /// When it arrived, and when it was measured on the source's own clock.
    pub stamp: Stamp,
    /// The reading.
    pub wrench: Wrench,
    /// The number that the source gives to the reading, if it counts them.
    pub sequence: Option<u32>,
    /// The source's status bits. 0 is healthy.
    pub status: u32,
    /// Readings lost between the one before and this one.
    pub lost_before: u32,
}

/// A stream of readings.
pub trait WrenchSource {
    /// Waits for the next reading. `None` if there is none in time.
    ///
    /// # Errors
    /// A source that cannot be read, or that reports that its readings cannot be trusted.
    fn next_sample(&mut self, within: Duration) -> Result<Option<WrenchSample>, RigError>;
}
