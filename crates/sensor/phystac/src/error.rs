//! What ends an operation.

use core::fmt;

use embedded_hal::i2c::{self, ErrorKind};

use crate::channels::Channels;

/// Why an operation came to nothing; `E` is the bus's own error.
///
/// Of [`PhysTac`](crate::PhysTac), whatever the error, the next call starts from the switch's mask again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error<E> {
    /// A transaction failed otherwise than by a missing acknowledge. The bus works; trying again may help.
    Bus(E),
    /// No transaction goes through any more: free the bus ([`recovery`](crate::recovery)), then try again.
    BusHung {
        /// The taxel whose channel was open, if it was one alone.
        taxel: Option<usize>,
        /// What the bus said first.
        source: E,
    },
    /// The switch does not acknowledge its address.
    SwitchMissing,
    /// The switch has other channels open than it was told: it lost power or was reset.
    SwitchReset {
        /// The channels it was told to open.
        wrote: Channels,
        /// The channels that it has open.
        found: Channels,
    },
    /// The barometer does not acknowledge its address.
    BarometerMissing,
    /// Not one barometer takes the trigger: none acknowledges, or all still convert.
    NotTriggered,
    /// The conversion did not end in time, or was lost with the part's power.
    ConversionStuck,
    /// Something answers at a barometer's address though all channels are closed: another device on the bus itself, which would speak at the same
    /// time as the barometers.
    AddressConflict {
        /// The address.
        address: u8,
    },
    /// The part that answers is another one: its register of identity does not hold what it should.
    WrongChip {
        /// What it holds.
        found: u8,
    },
    /// What the part was calibrated to cannot be read, or fails its check.
    Uncalibrated,
    /// The part has lost its settings, with its power.
    Restarted,
    /// The barometer's pressure configuration reads back otherwise than written.
    OversamplingRefused {
        /// The byte written.
        wrote: u8,
        /// The byte read back.
        found: u8,
    },
}

impl<E: i2c::Error> Error<E> {
    /// A failed transaction: `missing` if nobody acknowledged, else the bus's error.
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
                write!(f, "the switch was told to open {wrote} and has {found} open")
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
                    "the barometer was told {wrote:#04x} as its pressure configuration and keeps {found:#04x}"
                )
            }
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}
