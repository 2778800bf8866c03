//! The sensor: all barometers at once.

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;

use super::{AtOnce, now};
use crate::asynch;
use crate::clock::Clock;
use crate::error::Error;
use crate::frame::Frame;
use crate::settings::Settings;

/// Up to `N` barometers on a bus, behind switches or not, read as frames.
///
/// A frame is triggered for all barometers at once, with one write for all that need the same bytes, so that its samples are of one moment; then
/// each is asked, through its own channel, until it has ended, and read. What goes wrong with one taxel is that taxel's [`Fault`] and stops no
/// other. One that failed in a frame is switched on anew before the next trigger, and left out of the frame if it is still converting or fails
/// again: its sample would be of an earlier moment than the frame says.
///
/// Chips that convert temperature apart do so in every sixteenth frame, after the pressures, and between count with the last one.
///
/// After an [`Error`] nothing is taken for granted: the next call closes all channels, sees that the switches obey and that nobody answers at the
/// barometers' addresses, and looks into each channel before any broadcast.
#[derive(Debug)]
pub struct PhysTac<I2C, D, C, const N: usize>(asynch::PhysTac<AtOnce<I2C>, AtOnce<D>, C, N>);

impl<I2C: I2c, D: DelayNs, C: Clock, const N: usize> PhysTac<I2C, D, C, N> {
    /// The sensor on a bus. Nothing is sent yet.
    pub const fn new(i2c: I2C, delay: D, clock: C, settings: Settings<N>) -> Self {
        Self(asynch::PhysTac::new(AtOnce(i2c), AtOnce(delay), clock, settings))
    }

    /// How it is wired and timed.
    #[must_use]
    pub const fn settings(&self) -> &Settings<N> {
        self.0.settings()
    }

    /// Gives the bus, the delay and the clock back. Channels stay open unless [`stop`](Self::stop) closed them.
    pub fn release(self) -> (I2C, D, C) {
        let (AtOnce(i2c), AtOnce(delay), clock) = self.0.release();
        (i2c, delay, clock)
    }

    /// Closes all channels, sees that the switches obey and that nothing else has a barometer's address, looks into each channel alone, switches
    /// the barometers on, and lets conversions under way end.
    ///
    /// The other operations do so by themselves when needed.
    ///
    /// # Errors
    /// Any but those of a single barometer; [`Error::AddressConflict`]; [`Error::BusHung`] with the taxel, if opening its channel hangs the bus.
    pub fn start(&mut self) -> Result<(), Error<I2C::Error>> {
        now(self.0.start())
    }

    /// Triggers the next frame, unless one is under way. Right after [`frame`](Self::frame) the barometers convert while the caller computes.
    ///
    /// # Errors
    /// [`Error::NotTriggered`], and those of [`start`](Self::start).
    pub fn trigger(&mut self) -> Result<(), Error<I2C::Error>> {
        now(self.0.trigger())
    }

    /// Reads the frame under way, and triggers one before if there is none.
    ///
    /// # Errors
    /// What stops all taxels; those of [`trigger`](Self::trigger). The frame under way is lost.
    pub fn frame(&mut self) -> Result<Frame<N>, Error<I2C::Error>> {
        now(self.0.frame())
    }

    /// Closes all channels. A frame under way is lost.
    ///
    /// # Errors
    /// [`Error::SwitchMissing`], [`Error::Bus`], [`Error::BusHung`].
    pub fn stop(&mut self) -> Result<(), Error<I2C::Error>> {
        now(self.0.stop())
    }

    /// Lends the bus to its owner, to free it after [`Error::BusHung`]: by [`recovery`](crate::recovery), or a way of the bus's own.
    ///
    /// Which taxels are isolated is not forgotten.
    pub fn recover<T>(&mut self, free: impl FnOnce(&mut I2C, &mut D) -> T) -> T {
        self.0.recover(|i2c, delay| free(&mut i2c.0, &mut delay.0))
    }

    /// Gives isolated taxels another chance at once. A taxel is isolated when the bus hung twice running with its channel alone open, and is looked
    /// into again by itself after [`Settings::retry_us`].
    pub const fn readmit(&mut self) {
        self.0.readmit();
    }

    /// Changes [`Settings::conversion_us`], from the frame under way on.
    pub const fn set_conversion_us(&mut self, conversion_us: u32) {
        self.0.set_conversion_us(conversion_us);
    }
}
