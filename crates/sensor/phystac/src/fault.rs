//! Faults of one taxel.

use core::fmt;

use embedded_hal::i2c::ErrorKind;

/// Why a taxel has no value in a frame. The other taxels have theirs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fault {
    /// Its barometer does not acknowledge.
    Missing,
    /// It has no sample of this frame: its conversion did not end in time, or was lost when the
    /// part lost power.
    Stuck,
    /// The bus failed while its channel was open, and works with the channel closed.
    Bus(ErrorKind),
    /// Its channel hung the bus, and stays closed until it is tried again: after
    /// [`Settings::retry_us`](crate::Settings::retry_us), or by
    /// [`PhysTac::readmit`](crate::PhysTac::readmit).
    Isolated,
    /// Its barometer does not keep the oversampling that is written.
    Refused,
    /// The part at its address is not the one described.
    WrongChip,
    /// The calibration of its barometer cannot be read, or fails its check.
    Uncalibrated,
    /// Its barometer lost power, and with it its settings. It is started again before the next
    /// frame.
    Restarted,
    /// The sensor has no such taxel: its [`Wiring`](crate::Wiring) has fewer taxels than its
    /// capacity `N`.
    NotWired,
    /// The pressure is at an end of the range or beyond. Found by
    /// [`Sample::pressure_pa`](crate::Sample::pressure_pa) and [`Health`](crate::Health).
    Saturated,
    /// The value was the same, bit for bit, for too many frames. Found by
    /// [`Health`](crate::Health).
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
