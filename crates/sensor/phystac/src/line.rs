//! One chip on the bus: its address, through the channel that is open.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use crate::error::Error;
use crate::patience::Patience;

/// The bus as a chip's driver sees it.
pub(crate) struct Line<'a, I, D> {
    i2c: &'a mut I,
    delay: &'a mut D,
    address: u8,
    patience: &'a mut Patience,
}

impl<'a, I: I2c, D: DelayNs> Line<'a, I, D> {
    pub(crate) const fn new(
        i2c: &'a mut I,
        delay: &'a mut D,
        address: u8,
        patience: &'a mut Patience,
    ) -> Self {
        Self {
            i2c,
            delay,
            address,
            patience,
        }
    }

    pub(crate) async fn write(&mut self, bytes: &[u8]) -> Result<(), Error<I::Error>> {
        let written = self.i2c.write(self.address, bytes).await;
        written.map_err(|source| Error::of_transaction(source, Error::BarometerMissing))
    }

    /// A write that resets the chip. The chip may not acknowledge its last byte.
    pub(crate) async fn reset(&mut self, bytes: &[u8]) -> Result<(), Error<I::Error>> {
        match self.write(bytes).await {
            Err(Error::BarometerMissing) => Ok(()), // the next transaction finds out if the chip is missing
            written => written,
        }
    }

    pub(crate) async fn read<const LEN: usize>(
        &mut self,
        register: u8,
    ) -> Result<[u8; LEN], Error<I::Error>> {
        let mut bytes = [0; LEN];
        let read = self.i2c.write_read(self.address, &[register], &mut bytes).await;
        read.map_err(|source| Error::of_transaction(source, Error::BarometerMissing))?;
        Ok(bytes)
    }

    /// Checks the chip's identity register.
    pub(crate) async fn identify(&mut self, register: u8, identity: u8) -> Result<(), Error<I::Error>> {
        let [found] = self.read(register).await?;
        if found == identity {
            Ok(())
        } else {
            Err(Error::WrongChip { found })
        }
    }

    /// Waits for the chip, µs.
    pub(crate) async fn pause_us(&mut self, us: u32) {
        self.delay.delay_us(us).await;
    }

    /// Waits between two polls, and counts this wait off the patience.
    ///
    /// # Errors
    /// [`Error::ConversionStuck`] if no waits are left.
    pub(crate) async fn wait(&mut self) -> Result<(), Error<I::Error>> {
        self.patience.waits = self.patience.waits.checked_sub(1).ok_or(Error::ConversionStuck)?;
        self.delay.delay_us(self.patience.interval_us).await;
        Ok(())
    }
}

/// The unsigned number of three bytes, most significant byte first.
pub(crate) const fn u24_be([high, middle, low]: [u8; 3]) -> u32 {
    u32::from_be_bytes([0, high, middle, low])
}

/// The unsigned number of three bytes, least significant byte first.
pub(crate) const fn u24_le([low, middle, high]: [u8; 3]) -> u32 {
    u32::from_le_bytes([low, middle, high, 0])
}

/// A two's complement number of `bits` bits.
pub(crate) const fn signed(number: u32, bits: u32) -> i32 {
    let shift = 32 - bits;
    (number << shift).cast_signed() >> shift
}
