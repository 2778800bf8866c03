//! The barometer.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use crate::conversion::Sample;
use crate::error::Error;
use crate::register::{self, Oversampling, Write};
use crate::settings::Patience;

/// The CPS135B, a barometer that converts when told to and sleeps otherwise.
///
/// Always at 0x6D, so there is one to a bus, or to a switch's channel. Through a switch with several channels open,
/// [`trigger`](Self::trigger) reaches all of them; everything else wants exactly one.
#[derive(Debug)]
pub struct Cps135b<I2C> {
    i2c: I2C,
}

impl<I2C: I2c> Cps135b<I2C> {
    /// The barometer on a bus.
    pub const fn new(i2c: I2C) -> Self {
        Self { i2c }
    }

    /// Gives the bus back.
    pub fn release(self) -> I2C {
        self.i2c
    }

    /// Starts a conversion of temperature and pressure.
    ///
    /// # Errors
    /// [`Error::BarometerMissing`], [`Error::Bus`].
    pub async fn trigger(&mut self) -> Result<(), Error<I2C::Error>> {
        self.write(Write::TRIGGER).await
    }

    /// Whether a conversion is under way.
    ///
    /// # Errors
    /// [`Error::BarometerMissing`], [`Error::Bus`].
    pub async fn is_converting(&mut self) -> Result<bool, Error<I2C::Error>> {
        let [command] = self.read(register::COMMAND).await?;
        Ok(register::is_converting(command))
    }

    /// What the last conversion gave. While one is under way that is the one before: [`wait`](Self::wait) first.
    ///
    /// # Errors
    /// [`Error::ConversionStuck`] if the part has not converted since it woke up, [`Error::BarometerMissing`], [`Error::Bus`].
    pub async fn sample(&mut self) -> Result<Sample, Error<I2C::Error>> {
        let data = self.read(register::DATA).await?;
        register::sample(data).ok_or(Error::ConversionStuck)
    }

    /// Waits until no conversion is under way. Takes what it waits off `patience`.
    ///
    /// # Errors
    /// [`Error::ConversionStuck`] once `patience` is used up, [`Error::BarometerMissing`], [`Error::Bus`].
    pub async fn wait(
        &mut self,
        delay: &mut impl DelayNs,
        patience: &mut Patience,
    ) -> Result<(), Error<I2C::Error>> {
        while self.is_converting().await? {
            patience.waits = patience.waits.checked_sub(1).ok_or(Error::ConversionStuck)?;
            delay.delay_us(patience.interval_us).await;
        }
        Ok(())
    }

    /// How many conversions make one pressure.
    ///
    /// # Errors
    /// [`Error::BarometerMissing`], [`Error::Bus`].
    pub async fn oversampling(&mut self) -> Result<Oversampling, Error<I2C::Error>> {
        let [configuration] = self.read(register::PRESSURE_CONFIGURATION).await?;
        Ok(Oversampling::of(configuration))
    }

    /// Changes how many conversions make one pressure, until the part loses power. Not while a conversion is under way.
    ///
    /// # Errors
    /// [`Error::OversamplingRefused`] if the part does not keep it, [`Error::BarometerMissing`], [`Error::Bus`].
    pub async fn set_oversampling(&mut self, oversampling: Oversampling) -> Result<(), Error<I2C::Error>> {
        let [configuration] = self.read(register::PRESSURE_CONFIGURATION).await?;
        let write = Write::oversampling(oversampling, configuration);
        self.write(write).await?;
        let [_, wrote] = write.bytes();
        let [found] = self.read(register::PRESSURE_CONFIGURATION).await?;
        if found == wrote {
            Ok(())
        } else {
            Err(Error::OversamplingRefused { wrote, found })
        }
    }

    async fn write(&mut self, write: Write) -> Result<(), Error<I2C::Error>> {
        let written = self.i2c.write(register::ADDRESS, &write.bytes()).await;
        written.map_err(|source| Error::of_transaction(source, Error::BarometerMissing))
    }

    async fn read<const LEN: usize>(&mut self, register: u8) -> Result<[u8; LEN], Error<I2C::Error>> {
        let mut bytes = [0; LEN];
        let read = self
            .i2c
            .write_read(register::ADDRESS, &[register], &mut bytes)
            .await;
        read.map_err(|source| Error::of_transaction(source, Error::BarometerMissing))?;
        Ok(bytes)
    }
}
