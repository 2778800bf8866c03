//! Errors that end an operation.

use core::fmt;

use embedded_hal::i2c::{self, ErrorKind};

use crate::channels::Channels;

/// Why an operation failed. `E` is the error of the bus.
///
/// After any error of [`PhysTac`](crate::PhysTac) the next call starts over with the switch's mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error<E> {
    /// A transaction failed, and not by a missing acknowledge. The bus works; trying again may
    /// help.
    Bus(E),
    /// No transaction succeeds any more: free the bus ([`recovery`](crate::recovery)), then try
    /// again.
    BusHung {
        /// The taxel whose channel was open, if only one was.
        taxel: Option<usize>,
        /// The first error that the bus gave.
        source: E,
    },
    /// The switch does not acknowledge its address.
    SwitchMissing,
    /// The switch has other channels open than were written: it lost power or was reset.
    SwitchReset {
        /// The channels that were written.
        wrote: Channels,
        /// The channels that are open.
        found: Channels,
    },
    /// The barometer does not acknowledge its address.
    BarometerMissing,
    /// No barometer took the trigger: none acknowledges, or all still convert.
    NotTriggered,
    /// The conversion did not end in time, or was lost when the part lost power.
    ConversionStuck,
    /// Something answers at a barometer's address while all channels are closed: another device on
    /// the bus itself. It would answer together with the barometers.
    AddressConflict {
        /// The address.
        address: u8,
    },
    /// The part at this address is another one: its identity register has another content than
    /// expected.
    WrongChip {
        /// The content of the identity register.
        found: u8,
    },
    /// The part's calibration cannot be read, or fails its check.
    Uncalibrated,
    /// The part lost power, and with it its settings.
    Restarted,
    /// The barometer's pressure configuration reads back different from what was written.
    OversamplingRefused {
        /// The byte written.
        wrote: u8,
        /// The byte read back.
        found: u8,
    },
}

impl<E: i2c::Error> Error<E> {
    /// The error of a failed transaction: `missing` if nothing acknowledged, else the bus's error.
    pub(crate) fn of_transaction(source: E, missing: Self) -> Self {
        match source.kind() {
            ErrorKind::NoAcknowledge(_) => missing,
            _ => Self::Bus(source),
        }
    }
}

impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bus(source) => write!(f, "the bus failed: {source:?}"),
            Self::BusHung {
                taxel: Some(taxel),
                source,
            } => {
                write!(
                    f,
                    "the bus hangs since the channel of taxel {taxel} was open: {source:?}"
                )
            }
            Self::BusHung { taxel: None, source } => write!(f, "the bus hangs: {source:?}"),
            Self::SwitchMissing => f.write_str("the switch does not acknowledge its address"),
            Self::SwitchReset { wrote, found } => {
                write!(f, "the switch was set to open {wrote}, but has {found} open")
            }
            Self::BarometerMissing => f.write_str("the barometer does not acknowledge its address"),
            Self::NotTriggered => f.write_str("no barometer takes the trigger"),
            Self::ConversionStuck => f.write_str("the conversion does not end"),
            Self::AddressConflict { address } => {
                write!(
                    f,
                    "something answers at the barometers' address {address:#04x} with all channels of the switches closed"
                )
            }
            Self::WrongChip { found } => {
                write!(f, "another part answers: its identity is {found:#04x}")
            }
            Self::Uncalibrated => f.write_str("the barometer's calibration fails its check"),
            Self::Restarted => f.write_str("the barometer lost its settings"),
            Self::OversamplingRefused { wrote, found } => {
                write!(
                    f,
                    "the pressure configuration of the barometer was set to {wrote:#04x}, but is {found:#04x}"
                )
            }
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}
