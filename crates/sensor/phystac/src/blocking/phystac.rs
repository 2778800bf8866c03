//! The sensor: all barometers of one bus.

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;

use super::{AtOnce, now};
use crate::asynch;
use crate::clock::Clock;
use crate::error::Error;
use crate::frame::Frame;
use crate::settings::Settings;

/// Up to `N` barometers on an I²C bus, with or without switches, read as frames.
///
/// All barometers are triggered at the same moment: one write for all that take the same bytes at
/// the same address. Each barometer is then polled and read through its own channel. A failure of
/// one taxel is a [`Fault`](crate::Fault) of that taxel; the other taxels have their values. A
/// taxel that failed is started again before the next trigger. It is left out of that frame if it
/// still converts or fails again, because its sample would be older than the frame.
///
/// Chips that convert temperature separately do so in every sixteenth frame, after the pressures.
/// The frames between use the last temperature.
///
/// After an [`Error`] the next call starts over: it closes all channels, checks that the switches
/// take their masks and that nothing else answers at the barometers' addresses, and opens each
/// channel alone before any write to several channels.
#[derive(Debug)]
pub struct PhysTac<I2C, D, C, const N: usize>(asynch::PhysTac<AtOnce<I2C>, AtOnce<D>, C, N>);

impl<I2C: I2c, D: DelayNs, C: Clock, const N: usize> PhysTac<I2C, D, C, N> {
    /// A sensor on a bus. Sends nothing yet.
    pub const fn new(i2c: I2C, delay: D, clock: C, settings: Settings<N>) -> Self {
        Self(asynch::PhysTac::new(AtOnce(i2c), AtOnce(delay), clock, settings))
    }

    /// Wiring and timing of the sensor.
    #[must_use]
    pub const fn settings(&self) -> &Settings<N> {
        self.0.settings()
    }

    /// Returns the bus, the delay and the clock. Channels stay open unless [`stop`](Self::stop)
    /// closed them.
    pub fn release(self) -> (I2C, D, C) {
        let (AtOnce(i2c), AtOnce(delay), clock) = self.0.release();
        (i2c, delay, clock)
    }

    /// Closes all channels; checks that the switches take their masks and that no other device has
    /// the address of a barometer behind a switch; opens each channel alone; starts the barometers;
    /// waits until conversions in progress have ended.
    ///
    /// The other operations call this when it is needed.
    ///
    /// # Errors
    /// Every error except those of a single barometer; [`Error::AddressConflict`];
    /// [`Error::BusHung`] with the taxel, if opening its channel hangs the bus.
    pub fn start(&mut self) -> Result<(), Error<I2C::Error>> {
        now(self.0.start())
    }

    /// Triggers the next frame, unless one is in progress. Call it right after
    /// [`frame`](Self::frame): the barometers then convert while the caller computes.
    ///
    /// # Errors
    /// [`Error::NotTriggered`], and those of [`start`](Self::start).
    pub fn trigger(&mut self) -> Result<(), Error<I2C::Error>> {
        now(self.0.trigger())
    }

    /// Reads the frame in progress. Without one, triggers a frame first.
    ///
    /// # Errors
    /// Errors that concern all taxels; those of [`trigger`](Self::trigger). The frame in progress
    /// is lost.
    pub fn frame(&mut self) -> Result<Frame<N>, Error<I2C::Error>> {
        now(self.0.frame())
    }

    /// Closes all channels. A frame in progress is lost.
    ///
    /// # Errors
    /// [`Error::SwitchMissing`], [`Error::Bus`], [`Error::BusHung`].
    pub fn stop(&mut self) -> Result<(), Error<I2C::Error>> {
        now(self.0.stop())
    }

    /// Lends the bus to the caller, to free it after [`Error::BusHung`], with
    /// [`recovery`](crate::recovery) or in another way that the bus offers.
    ///
    /// Isolated taxels stay isolated.
    pub fn recover<T>(&mut self, free: impl FnOnce(&mut I2C, &mut D) -> T) -> T {
        self.0.recover(|i2c, delay| free(&mut i2c.0, &mut delay.0))
    }

    /// Lets isolated taxels take part again at once. A taxel is isolated when the bus hung twice in
    /// a row while only its channel was open. Without this call the driver tries it again after
    /// [`Settings::retry_us`].
    pub const fn readmit(&mut self) {
        self.0.readmit();
    }

    /// Changes [`Settings::conversion_us`], starting with the frame in progress.
    pub const fn set_conversion_us(&mut self, conversion_us: u32) {
        self.0.set_conversion_us(conversion_us);
    }
}
