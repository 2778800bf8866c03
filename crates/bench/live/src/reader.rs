//! One frame after the other.

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use phystac::{Clock, PhysTac};
use twintac_log::TactileFrame;

use crate::error::bus_error;
use crate::{LiveError, PowerOn, Screening};

/// A frame as it is handed out.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Its number, of all that were asked for: numbers that are missing were missed, or the bus gave none.
    pub sequence: u64,
    /// When the taxels were triggered, s of the bench's clock.
    pub bench_s: f64,
    /// What they gave.
    pub frame: TactileFrame,
}

/// Reads frames and numbers them, on the caller's own thread.
#[derive(Debug)]
pub struct FrameReader<I2C, D, C, const N: usize> {
    phystac: PhysTac<I2C, D, C, N>,
    screening: Screening<N>,
    sequence: u64,
}

impl<I2C: I2c, D: DelayNs, C: Clock, const N: usize> FrameReader<I2C, D, C, N> {
    /// Of a sensor that was switched on.
    #[must_use]
    pub fn new(phystac: PhysTac<I2C, D, C, N>, checked: &PowerOn) -> Self {
        Self {
            phystac,
            screening: checked.screening(),
            sequence: 0,
        }
    }

    /// The next frame. A taxel that is saturated or frozen keeps its counts and has no pressure.
    ///
    /// # Errors
    /// [`LiveError::Bus`]: what stops all taxels. The next call starts over.
    pub fn read(&mut self) -> Result<Reading, LiveError> {
        let sequence = self.sequence;
        self.sequence += 1;
        let frame = self.phystac.frame().map_err(bus_error)?;
        Ok(Reading {
            sequence,
            bench_s: frame.triggered_us as f64 * 1e-6,
            frame: self.screening.frame(frame),
        })
    }

    /// Closes all channels.
    ///
    /// # Errors
    /// [`LiveError::Bus`].
    pub fn stop(&mut self) -> Result<(), LiveError> {
        self.phystac.stop().map_err(bus_error)
    }
}
