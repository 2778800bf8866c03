//! Readings of a sensor with analog gauges.

use std::time::Duration;

use super::{AnalogCalibration, WrenchSample, WrenchSource};
use crate::{RigError, Stamp};

/// Six gauge voltages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoltageSample {
    /// When they were measured.
    pub stamp: Stamp,
    /// The voltages, V.
    pub volts: [f64; 6],
    /// Samples lost between the one before and this one.
    pub lost_before: u32,
}

/// A measuring card that reads six gauges. `F` is any function that waits for the next voltages for
/// at most the given time, as [`WrenchSource::next_sample`] does.
#[derive(Clone, Debug)]
pub struct Analog<F> {
    read: F,
    /// The calibration from voltages to a wrench.
    pub calibration: AnalogCalibration,
}

impl<F: FnMut(Duration) -> Result<Option<VoltageSample>, RigError>> Analog<F> {
    /// Readings of a card with a sensor's calibration.
    pub fn new(read: F, calibration: AnalogCalibration) -> Self {
        Self { read, calibration }
    }
}

impl<F: FnMut(Duration) -> Result<Option<VoltageSample>, RigError>> WrenchSource for Analog<F> {
    fn next_sample(&mut self, within: Duration) -> Result<Option<WrenchSample>, RigError> {
        let Some(sample) = (self.read)(within)? else {
            return Ok(None);
        };
        Ok(Some(WrenchSample {
            stamp: sample.stamp,
            wrench: self.calibration.wrench(sample.volts)?,
            sequence: None,
            status: 0,
            lost_before: sample.lost_before,
        }))
    }
}
