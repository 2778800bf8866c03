//! Frees a hung bus by driving its pins directly.
//!
//! If the controller is reset in the middle of a read, a part can be left waiting for more clocks
//! while it holds SDA low. Nine clocks let it finish any byte (I²C specification UM10204, section
//! 3.1.16). A part behind the switch gets these clocks only while its channel is open. The switch's
//! RESET closes all channels, so it helps whatever hangs behind the switch.
//!
//! The pins belong to the I²C peripheral while it runs.
//! [`PhysTac::recover`](crate::PhysTac::recover) lends the bus to the caller for this;
//! [`PhysTac::release`](crate::PhysTac::release) gives it back for good. RESET is a pin of its own:
//!
//! ```
//! use embedded_hal::{delay::DelayNs, digital::OutputPin, i2c::I2c};
//! use phystac::{Clock, Error, Frame, PhysTac, recovery};
//!
//! /// The next frame; none if the bus had to be freed.
//! fn frame<B: I2c>(
//!     sensor: &mut PhysTac<B, impl DelayNs, impl Clock, 8>,
//!     reset: &mut impl OutputPin,
//! ) -> Result<Option<Frame<8>>, Error<B::Error>> {
//!     match sensor.frame() {
//!         Err(hung @ Error::BusHung { .. }) => {
//!             let freed = sensor.recover(|_, delay| recovery::reset_switch(reset, delay));
//!             if freed.is_ok() { Ok(None) } else { Err(hung) }
//!         }
//!         result => result.map(Some),
//!     }
//! }
//! ```

use core::fmt;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{Error as _, ErrorKind, InputPin, OutputPin, PinState};

/// Half a clock at 100 kHz, a rate that every part supports.
const HALF_CLOCK_US: u32 = 5;

/// Sends nine clocks and a STOP, then checks that both lines are high. Takes a tenth of a
/// millisecond.
///
/// Both pins must be open-drain: high means released.
///
/// # Errors
/// A line stays low, or a pin fails.
pub fn free_bus(
    scl: &mut (impl OutputPin + InputPin),
    sda: &mut (impl OutputPin + InputPin),
    delay: &mut impl DelayNs,
) -> Result<(), RecoveryError> {
    set(sda, PinState::High)?;
    for _ in 0..9 {
        set(scl, PinState::Low)?;
        delay.delay_us(HALF_CLOCK_US);
        set(scl, PinState::High)?;
        delay.delay_us(HALF_CLOCK_US);
    }
    // STOP: SDA rises while SCL is high.
    set(scl, PinState::Low)?;
    set(sda, PinState::Low)?;
    delay.delay_us(HALF_CLOCK_US);
    set(scl, PinState::High)?;
    delay.delay_us(HALF_CLOCK_US);
    set(sda, PinState::High)?;
    delay.delay_us(HALF_CLOCK_US);
    if is_low(scl)? {
        return Err(RecoveryError::ClockHeldLow);
    }
    if is_low(sda)? {
        return Err(RecoveryError::DataHeldLow);
    }
    Ok(())
}

/// Resets the switch through its RESET pin, which is active low: all channels close, and the switch
/// releases the bus.
///
/// # Errors
/// The pin fails.
pub fn reset_switch(reset: &mut impl OutputPin, delay: &mut impl DelayNs) -> Result<(), RecoveryError> {
    set(reset, PinState::Low)?;
    delay.delay_us(1); // at least 6 ns
    set(reset, PinState::High)?;
    delay.delay_us(1); // SDA is released after 500 ns
    Ok(())
}

fn set(pin: &mut impl OutputPin, state: PinState) -> Result<(), RecoveryError> {
    pin.set_state(state)
        .map_err(|error| RecoveryError::Pin(error.kind()))
}

fn is_low(pin: &mut impl InputPin) -> Result<bool, RecoveryError> {
    pin.is_low().map_err(|error| RecoveryError::Pin(error.kind()))
}

/// Why the bus is not free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecoveryError {
    /// A part, or a short, holds SCL low: no clock gets through.
    ClockHeldLow,
    /// A part, or a short, still holds SDA low after nine clocks.
    DataHeldLow,
    /// A pin failed.
    Pin(ErrorKind),
}

impl fmt::Display for RecoveryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ClockHeldLow => f.write_str("SCL is held low"),
            Self::DataHeldLow => f.write_str("SDA is held low after nine clocks"),
            Self::Pin(kind) => write!(f, "a pin failed: {kind}"),
        }
    }
}

impl core::error::Error for RecoveryError {}
