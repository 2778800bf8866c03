//! What can be wrong with one taxel.

use core::fmt;

use embedded_hal::i2c::ErrorKind;

/// Why a taxel has no value in a frame; the other taxels have theirs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fault {
    /// Its barometer does not acknowledge.
    Missing,
    /// It has no sample of this frame: its conversion did not end in time, or was lost with its power.
    Stuck,
    /// The bus failed with its channel open, and works again with it closed.
    Bus(ErrorKind),
    /// Its channel hung the bus, and is closed until it is looked into again: after [`Settings::retry_us`](crate::Settings::retry_us), or
    /// [`PhysTac::readmit`](crate::PhysTac::readmit).
    Isolated,
    /// Its barometer does not keep the oversampling that it is given.
    Refused,
    /// Another part than the one described answers at its address.
    WrongChip,
    /// What its barometer was calibrated to cannot be read, or fails its check.
    Uncalibrated,
    /// Its barometer lost its settings, with its power; it is switched on anew before the next frame.
    Restarted,
    /// The sensor has no such taxel: its [`Wiring`](crate::Wiring) is shorter than its capacity.
    NotWired,
    /// The pressure is at an end of the range or beyond; found by [`Sample::pressure_pa`](crate::Sample::pressure_pa) and
    /// [`Health`](crate::Health).
    Saturated,
    /// The same value, bit for bit, for too many frames; found by [`Health`](crate::Health).
    Frozen,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("the barometer does not acknowledge"),
            Self::Stuck => f.write_str("the conversion does not end"),
            Self::Bus(kind) => write!(f, "the bus fails on this channel: {kind}"),
            Self::Isolated => f.write_str("the channel hung the bus and is kept closed"),
            Self::Refused => f.write_str("the barometer does not keep its oversampling"),
            Self::WrongChip => f.write_str("another part answers at its address"),
            Self::Uncalibrated => f.write_str("the barometer's calibration fails its check"),
            Self::Restarted => f.write_str("the barometer lost its settings"),
            Self::NotWired => f.write_str("there is no such taxel"),
            Self::Saturated => f.write_str("the pressure is out of range"),
            Self::Frozen => f.write_str("the value no longer changes"),
        }
    }
}

impl core::error::Error for Fault {}
