//! The barometer.

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;

use super::{AtOnce, now};
use crate::asynch;
use crate::conversion::Sample;
use crate::error::Error;
use crate::register::Oversampling;
use crate::settings::Patience;

/// The CPS135B, a barometer that converts when told to and sleeps otherwise.
///
/// Always at 0x6D, so there is one to a bus, or to a switch's channel. Through a switch with several channels open,
/// [`trigger`](Self::trigger) reaches all of them; everything else wants exactly one.
#[derive(Debug)]
pub struct Cps135b<I2C>(asynch::Cps135b<AtOnce<I2C>>);

impl<I2C: I2c> Cps135b<I2C> {
    /// The barometer on a bus.
    pub const fn new(i2c: I2C) -> Self {
        Self(asynch::Cps135b::new(AtOnce(i2c)))
    }

    /// Gives the bus back.
    pub fn release(self) -> I2C {
        self.0.release().0
    }

    /// Starts a conversion of temperature and pressure.
    ///
    /// # Errors
    /// [`Error::BarometerMissing`], [`Error::Bus`].
    pub fn trigger(&mut self) -> Result<(), Error<I2C::Error>> {
        now(self.0.trigger())
    }

    /// Whether a conversion is under way.
    ///
    /// # Errors
    /// [`Error::BarometerMissing`], [`Error::Bus`].
    pub fn is_converting(&mut self) -> Result<bool, Error<I2C::Error>> {
        now(self.0.is_converting())
    }

    /// What the last conversion gave. While one is under way that is the one before: [`wait`](Self::wait) first.
    ///
    /// # Errors
    /// [`Error::BarometerMissing`], [`Error::Bus`].
    pub fn sample(&mut self) -> Result<Sample, Error<I2C::Error>> {
        now(self.0.sample())
    }

    /// Waits until no conversion is under way. Takes what it waits off `patience`.
    ///
    /// # Errors
    /// [`Error::ConversionStuck`] once `patience` is used up, [`Error::BarometerMissing`], [`Error::Bus`].
    pub fn wait(
        &mut self,
        delay: &mut impl DelayNs,
        patience: &mut Patience,
    ) -> Result<(), Error<I2C::Error>> {
        now(self.0.wait(&mut AtOnce(delay), patience))
    }

    /// How many conversions make one pressure.
    ///
    /// # Errors
    /// [`Error::BarometerMissing`], [`Error::Bus`].
    pub fn oversampling(&mut self) -> Result<Oversampling, Error<I2C::Error>> {
        now(self.0.oversampling())
    }

    /// Changes how many conversions make one pressure, until the part loses power. Not while a conversion is under way.
    ///
    /// # Errors
    /// [`Error::OversamplingRefused`] if the part does not keep it, [`Error::BarometerMissing`], [`Error::Bus`].
    pub fn set_oversampling(&mut self, oversampling: Oversampling) -> Result<(), Error<I2C::Error>> {
        now(self.0.set_oversampling(oversampling))
    }
}
