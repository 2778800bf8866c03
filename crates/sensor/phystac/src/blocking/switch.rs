//! The I²C switch.

use embedded_hal::i2c::I2c;

use super::{AtOnce, now};
use crate::asynch;
use crate::channels::{Channels, SwitchAddress};
use crate::error::Error;

/// The TCA9548A, an I²C switch of eight channels.
///
/// The driver does not store the mask: a brown-out can clear it in the switch at any time.
#[derive(Debug)]
pub struct Tca9548a<I2C>(asynch::Tca9548a<AtOnce<I2C>>);

impl<I2C: I2c> Tca9548a<I2C> {
    /// The switch at an address of a bus.
    pub const fn new(i2c: I2C, address: SwitchAddress) -> Self {
        Self(asynch::Tca9548a::new(AtOnce(i2c), address))
    }

    /// Returns the bus.
    pub fn release(self) -> I2C {
        self.0.release().0
    }

    /// Opens these channels and closes all others. The change takes effect at the STOP of this
    /// transaction.
    ///
    /// # Errors
    /// [`Error::SwitchMissing`], [`Error::Bus`].
    pub fn select(&mut self, channels: Channels) -> Result<(), Error<I2C::Error>> {
        now(self.0.select(channels))
    }

    /// The channels that are open.
    ///
    /// # Errors
    /// [`Error::SwitchMissing`], [`Error::Bus`].
    pub fn selected(&mut self) -> Result<Channels, Error<I2C::Error>> {
        now(self.0.selected())
    }

    /// Checks that these channels are open, and no others.
    ///
    /// # Errors
    /// [`Error::SwitchReset`] if they are not, [`Error::SwitchMissing`], [`Error::Bus`].
    pub fn verify(&mut self, channels: Channels) -> Result<(), Error<I2C::Error>> {
        now(self.0.verify(channels))
    }
}
