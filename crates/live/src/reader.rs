//! One frame after the other.

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use phystac::{Clock, Health, PhysTac, Thresholds, Transfer};
use twintac_log::{TactileFrame, TaxelState};

use crate::LiveError;

/// A frame as it is handed out.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Its number, of all that were read: numbers that are missing were missed.
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
    transfer: Transfer,
    health: Health<N>,
    sequence: u64,
}

impl<I2C: I2c, D: DelayNs, C: Clock, const N: usize> FrameReader<I2C, D, C, N> {
    /// Of a sensor whose counts stand for this.
    #[must_use]
    pub fn new(phystac: PhysTac<I2C, D, C, N>, transfer: Transfer) -> Self {
        Self {
            phystac,
            transfer,
            health: Health::new(transfer, Thresholds::default()),
            sequence: 0,
        }
    }

    /// The next frame. A taxel that is saturated or frozen keeps its counts and has no pressure.
    ///
    /// # Errors
    /// [`LiveError::Bus`]: what stops all taxels. The next call starts over.
    pub fn read(&mut self) -> Result<Reading, LiveError> {
        let mut screened = self.phystac.frame().map_err(bus_error)?;
        let mut frame = TactileFrame::from_driver(&screened, &self.transfer);
        self.health.screen(&mut screened);
        for (index, fault) in screened.faults() {
            frame.taxels[index].state = TaxelState::from(fault);
            frame.taxels[index].pressure_pa = None;
        }
        let sequence = self.sequence;
        self.sequence += 1;
        Ok(Reading {
            sequence,
            bench_s: screened.triggered_us as f64 * 1e-6,
            frame,
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

pub(crate) fn bus_error<E: std::fmt::Debug>(error: phystac::Error<E>) -> LiveError {
    LiveError::Bus {
        problem: error.to_string(),
    }
}

/// A taxel's fault by its name; `None` if it is good.
pub(crate) fn fault_name(state: TaxelState) -> Option<&'static str> {
    match state {
        TaxelState::Good => None,
        TaxelState::Missing => Some("missing"),
        TaxelState::Stuck => Some("stuck"),
        TaxelState::BusError => Some("bus error"),
        TaxelState::Isolated => Some("isolated"),
        TaxelState::Refused => Some("refused"),
        TaxelState::Saturated => Some("saturated"),
        TaxelState::Frozen => Some("frozen"),
    }
}
