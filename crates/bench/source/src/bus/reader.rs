//! Reads one frame after the other.

use std::fmt;
use std::time::Duration;

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use phystac::{Clock, PhysTac};

use super::PowerOn;
use super::screening::Screening;
use crate::error::bus_error;
use crate::{Reading, SourceError, TactileSource};

/// Reads frames and numbers them, on the caller's thread.
pub struct FrameReader<I2C, D, C, const N: usize> {
    phystac: PhysTac<I2C, D, C, N>,
    screening: Screening<N>,
    sequence: u64,
    /// Whether the barometers convert the next frame while the caller handles this one.
    is_ahead: bool,
    free: Free<I2C, D>,
}

/// A function that frees a hung bus.
type Free<I2C, D> = Box<dyn FnMut(&mut I2C, &mut D) + Send>;

impl<I2C: I2c, D: DelayNs, C: Clock, const N: usize> FrameReader<I2C, D, C, N> {
    /// Reads a sensor that was switched on.
    #[must_use]
    pub fn new(phystac: PhysTac<I2C, D, C, N>, checked: &PowerOn) -> Self {
        Self {
            phystac,
            screening: checked.screening(),
            sequence: 0,
            is_ahead: false,
            free: Box::new(|_, _| {}),
        }
    }

    /// Lets the barometers convert the next frame while the caller handles this one. The rate is
    /// then higher, but a frame that is requested late is older.
    #[must_use]
    pub fn converting_ahead(mut self) -> Self {
        self.is_ahead = true;
        self
    }

    /// Sets the function that frees a hung bus. After that the channels are examined again.
    #[must_use]
    pub fn freed_by(mut self, free: impl FnMut(&mut I2C, &mut D) + Send + 'static) -> Self {
        self.free = Box::new(free);
        self
    }

    /// The next frame. A taxel that is saturated or frozen keeps its counts and has no pressure.
    ///
    /// # Errors
    /// [`SourceError::Wire`]: an error that affects all taxels. The next call starts again.
    pub fn read(&mut self) -> Result<Reading, SourceError> {
        let sequence = self.sequence;
        self.sequence += 1;
        let frame = match self.phystac.frame() {
            Ok(frame) => frame,
            Err(error) => {
                if matches!(error, phystac::Error::BusHung { .. }) {
                    self.phystac.recover(&mut self.free);
                }
                return Err(bus_error(error));
            }
        };
        if self.is_ahead {
            let _ = self.phystac.trigger(); // if it fails, the next frame reports the error
        }
        Ok(Reading {
            sequence,
            bench_s: frame.triggered_us as f64 * 1e-6,
            frame: self.screening.frame(frame),
        })
    }

    /// Closes all channels.
    ///
    /// # Errors
    /// [`SourceError::Wire`].
    pub fn stop(&mut self) -> Result<(), SourceError> {
        self.phystac.stop().map_err(bus_error)
    }
}

impl<I2C, D, C, const N: usize> TactileSource for FrameReader<I2C, D, C, N>
where
    I2C: I2c + Send,
    D: DelayNs + Send,
    C: Clock + Send,
{
    fn next_frame(&mut self, _: Duration) -> Result<Option<Reading>, SourceError> {
        self.read().map(Some)
    }

    fn stop(&mut self) -> Result<(), SourceError> {
        Self::stop(self)
    }
}

impl<I2C, D, C, const N: usize> fmt::Debug for FrameReader<I2C, D, C, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FrameReader")
            .field("sequence", &self.sequence)
            .finish_non_exhaustive()
    }
}
