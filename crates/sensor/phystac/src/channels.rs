//! A switch's channels and address.

use core::fmt;
use core::ops::BitOr;

/// A set of the switch's eight channels: bit N of the mask opens channel N.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Channels(u8);

impl Channels {
    /// No channel: the mask after power-up and reset.
    pub const NONE: Self = Self(0x00);
    /// All eight.
    pub const ALL: Self = Self(0xFF);

    /// The channels of a mask.
    #[must_use]
    pub const fn from_mask(mask: u8) -> Self {
        Self(mask)
    }

    /// Exactly one channel, 0 to 7. `None` for larger numbers.
    #[must_use]
    pub const fn only(channel: u8) -> Option<Self> {
        if channel < 8 {
            Some(Self(1 << channel))
        } else {
            None
        }
    }

    /// The byte that is written to the switch.
    #[must_use]
    pub const fn mask(self) -> u8 {
        self.0
    }

    /// Whether all channels of `other` are among these.
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// These channels without those of `other`.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }
}

impl BitOr for Channels {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl fmt::Display for Channels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "0b{:08b}", self.0)
    }
}

/// The switch's 7-bit I²C address, 0x70 to 0x77.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SwitchAddress(u8);

impl SwitchAddress {
    /// The lowest of the eight.
    pub(crate) const FIRST: u8 = 0x70;

    /// The address that the levels of the pins A2, A1 and A0 give.
    #[must_use]
    pub const fn from_pins(a2: bool, a1: bool, a0: bool) -> Self {
        Self(0x70 | (a2 as u8) << 2 | (a1 as u8) << 1 | a0 as u8)
    }

    /// The switch with this 7-bit address. `None` if no TCA9548A can have it.
    #[must_use]
    pub const fn new(address: u8) -> Option<Self> {
        match address {
            0x70..=0x77 => Some(Self(address)),
            _ => None,
        }
    }

    /// The 7-bit address.
    #[must_use]
    pub const fn get(self) -> u8 {
        self.0
    }
}

/// All address pins low: 0x70.
impl Default for SwitchAddress {
    fn default() -> Self {
        Self::from_pins(false, false, false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn address_pins_count_up_from_0x70() {
        assert_eq!(SwitchAddress::default().get(), 0x70);
        assert_eq!(SwitchAddress::from_pins(true, false, true).get(), 0x75);
        assert_eq!(
            SwitchAddress::new(0x77),
            Some(SwitchAddress::from_pins(true, true, true))
        );
        assert_eq!(SwitchAddress::new(0x6D), None);
    }
}
