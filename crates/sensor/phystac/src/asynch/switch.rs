//! The I²C switch.

use embedded_hal_async::i2c::I2c;

use crate::channels::{Channels, SwitchAddress};
use crate::error::Error;

/// The TCA9548A, an I²C switch of eight channels.
///
/// The driver does not store the mask: a brown-out can clear it in the switch at any time.
#[derive(Debug)]
pub struct Tca9548a<I2C> {
    i2c: I2C,
    address: u8,
}

impl<I2C: I2c> Tca9548a<I2C> {
    /// The switch at an address of a bus.
    pub const fn new(i2c: I2C, address: SwitchAddress) -> Self {
        Self {
            i2c,
            address: address.get(),
        }
    }

    /// Returns the bus.
    pub fn release(self) -> I2C {
        self.i2c
    }

    /// Opens these channels and closes all others. The change takes effect at the STOP of this
    /// transaction.
    ///
    /// # Errors
    /// [`Error::SwitchMissing`], [`Error::Bus`].
    pub async fn select(&mut self, channels: Channels) -> Result<(), Error<I2C::Error>> {
        let written = self.i2c.write(self.address, &[channels.mask()]).await;
        written.map_err(|source| Error::of_transaction(source, Error::SwitchMissing))
    }

    /// The channels that are open.
    ///
    /// # Errors
    /// [`Error::SwitchMissing`], [`Error::Bus`].
    pub async fn selected(&mut self) -> Result<Channels, Error<I2C::Error>> {
        let mut mask = [0];
        let read = self.i2c.read(self.address, &mut mask).await;
        read.map_err(|source| Error::of_transaction(source, Error::SwitchMissing))?;
        Ok(Channels::from_mask(mask[0]))
    }

    /// Checks that these channels are open, and no others.
    ///
    /// # Errors
    /// [`Error::SwitchReset`] if they are not, [`Error::SwitchMissing`], [`Error::Bus`].
    pub async fn verify(&mut self, channels: Channels) -> Result<(), Error<I2C::Error>> {
        let found = self.selected().await?;
        if found == channels {
            Ok(())
        } else {
            Err(Error::SwitchReset {
                wrote: channels,
                found,
            })
        }
    }
}
