//! The failure of a whole round, as a number on the line.

use core::fmt;

use phystac::Error;

/// The failure of a whole round. Lines contain these numbers: they never change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Trouble {
    /// No failure.
    #[default]
    None = 0,
    /// The bus failed, and works again.
    Bus = 1,
    /// No transaction succeeded any more. The node has tried to free the bus since.
    BusHung = 2,
    /// A switch does not acknowledge.
    SwitchMissing = 3,
    /// A switch lost its mask: it lost power or was reset.
    SwitchReset = 4,
    /// A device on the bus itself answers at the address of barometers behind switches.
    AddressConflict = 5,
    /// No barometer took the trigger.
    NotTriggered = 6,
    /// Another failure.
    Other = 7,
}

impl Trouble {
    /// Whether a reset of the switches may help.
    pub(crate) const fn needs_rescue(self) -> bool {
        matches!(
            self,
            Self::Bus | Self::BusHung | Self::SwitchMissing | Self::SwitchReset
        )
    }
}

impl<E> From<&Error<E>> for Trouble {
    fn from(error: &Error<E>) -> Self {
        match error {
            Error::Bus(_) => Self::Bus,
            Error::BusHung { .. } => Self::BusHung,
            Error::SwitchMissing => Self::SwitchMissing,
            Error::SwitchReset { .. } => Self::SwitchReset,
            Error::AddressConflict { .. } => Self::AddressConflict,
            Error::NotTriggered => Self::NotTriggered,
            _ => Self::Other,
        }
    }
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "the bus works",
            Self::Bus => "the bus failed",
            Self::BusHung => "the bus hangs",
            Self::SwitchMissing => "the switch does not acknowledge",
            Self::SwitchReset => "the switch lost its mask",
            Self::AddressConflict => "something answers at the barometers' address with all channels closed",
            Self::NotTriggered => "no barometer takes the trigger",
            Self::Other => "a round failed",
        })
    }
}
