//! The switch.

use embedded_hal::i2c::I2c;

use super::{AtOnce, now};
use crate::asynch;
use crate::channels::{Channels, SwitchAddress};
use crate::error::Error;

/// The TCA9548A, an I²C switch of eight channels.
///
/// Remembers nothing: a mask that was written may be gone, through a brown-out, by the time it is relied on.
#[derive(Debug)]
pub struct Tca9548a<I2C>(asynch::Tca9548a<AtOnce<I2C>>);

impl<I2C: I2c> Tca9548a<I2C> {
    /// The switch at an address of a bus.
    pub const fn new(i2c: I2C, address: SwitchAddress) -> Self {
        Self(asynch::Tca9548a::new(AtOnce(i2c), address))
    }

    /// Gives the bus back.
    pub fn release(self) -> I2C {
        self.0.release().0
    }

    /// Opens these channels and closes all others, from the STOP of this transaction on.
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

    /// Makes sure that these channels are open, and no others.
    ///
    /// # Errors
    /// [`Error::SwitchReset`] if they are not, [`Error::SwitchMissing`], [`Error::Bus`].
    pub fn verify(&mut self, channels: Channels) -> Result<(), Error<I2C::Error>> {
        now(self.0.verify(channels))
    }
}
