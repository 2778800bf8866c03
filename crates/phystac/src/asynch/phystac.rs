//! The sensor: all barometers at once.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::{Error as _, I2c};

use super::{Cps135b, Tca9548a};
use crate::channels::Channels;
use crate::clock::Clock;
use crate::conversion::Sample;
use crate::error::Error;
use crate::fault::Fault;
use crate::frame::Frame;
use crate::register::Oversampling;
use crate::settings::{Patience, Settings};

/// `N` barometers behind a switch, read as frames.
///
/// A frame is triggered for all barometers with one write, so that its samples are of one moment; then each is asked, through its
/// own channel, until it has ended, and read. What goes wrong with one taxel is that taxel's [`Fault`] and stops no other.
///
/// After an [`Error`] nothing is taken for granted: the next call closes all channels, sees that the switch obeys, and looks into each channel
/// before any broadcast.
#[derive(Debug)]
pub struct PhysTac<I2C, D, C, const N: usize> {
    i2c: I2C,
    delay: D,
    clock: C,
    settings: Settings<N>,
    /// Whether the last operation on the bus came to its end.
    is_ready: bool,
    /// When the frame under way was triggered.
    triggered_us: Option<u64>,
    /// The taxel with whose channel open the bus hung last.
    suspect: Option<usize>,
    /// Channels that hung the bus twice running.
    isolated: Channels,
}

impl<I2C: I2c, D: DelayNs, C: Clock, const N: usize> PhysTac<I2C, D, C, N> {
    /// The sensor on a bus. Nothing is sent yet.
    pub const fn new(i2c: I2C, delay: D, clock: C, settings: Settings<N>) -> Self {
        Self {
            i2c,
            delay,
            clock,
            settings,
            is_ready: false,
            triggered_us: None,
            suspect: None,
            isolated: Channels::NONE,
        }
    }

    /// Gives the bus, the delay and the clock back.
    pub fn release(self) -> (I2C, D, C) {
        (self.i2c, self.delay, self.clock)
    }

    /// Closes all channels, sees that the switch obeys, and looks into each channel alone. [`frame`](Self::frame) does so by itself when needed.
    ///
    /// # Errors
    /// Any but those of a single barometer; [`Error::BusHung`] with the taxel, if opening its channel hangs the bus.
    pub async fn start(&mut self) -> Result<(), Error<I2C::Error>> {
        self.is_ready = false;
        self.triggered_us = None;
        self.open(Channels::NONE).await?;
        self.switch().verify(Channels::NONE).await?;
        for (taxel, channel) in self.taxels() {
            let probed = self.probe(channel).await;
            if let Err(error) = probed {
                self.fault_of(taxel, channel, error).await?; // which every frame will find again
            }
        }
        self.open(Channels::NONE).await?;
        self.is_ready = true;
        Ok(())
    }

    /// Triggers the next frame, unless one is under way. Right after [`frame`](Self::frame) the barometers convert while the caller computes.
    ///
    /// # Errors
    /// [`Error::NotTriggered`] if nobody acknowledges, and those of [`start`](Self::start).
    pub async fn trigger(&mut self) -> Result<(), Error<I2C::Error>> {
        if self.triggered_us.is_none() {
            self.triggered_us = Some(self.broadcast().await?);
        }
        Ok(())
    }

    /// Reads the frame under way, and triggers one before if there is none.
    ///
    /// # Errors
    /// What stops all taxels; those of [`trigger`](Self::trigger). The frame under way is lost.
    pub async fn frame(&mut self) -> Result<Frame<N>, Error<I2C::Error>> {
        let triggered_us = match self.triggered_us.take() {
            Some(triggered_us) => triggered_us,
            None => self.broadcast().await?,
        };
        self.is_ready = false;
        let passed_us = self.clock.now_us().saturating_sub(triggered_us);
        let passed_us = u32::try_from(passed_us).unwrap_or(u32::MAX);
        self.delay
            .delay_us(self.settings.conversion_us.saturating_sub(passed_us))
            .await;

        let mut frame = Frame {
            triggered_us,
            read_us: [triggered_us; N],
            taxels: [Err(Fault::Isolated); N],
        };
        let mut patience = self.settings.patience;
        for (taxel, channel) in self.taxels() {
            let read = self.read(channel, &mut patience).await;
            frame.read_us[taxel] = self.clock.now_us();
            frame.taxels[taxel] = match read {
                Ok(sample) => Ok(sample),
                Err(error) => Err(self.fault_of(taxel, channel, error).await?),
            };
        }
        self.is_ready = true;
        self.suspect = None;
        Ok(frame)
    }

    /// Sets the oversampling of each barometer, until it loses power. More samples take longer: let [`set_conversion_us`](Self::set_conversion_us)
    /// follow.
    ///
    /// # Errors
    /// What stops all taxels. A frame under way is lost.
    pub async fn set_oversampling(
        &mut self,
        oversampling: Oversampling,
    ) -> Result<[Result<(), Fault>; N], Error<I2C::Error>> {
        self.start().await?;
        self.is_ready = false;
        let mut results = [Err(Fault::Isolated); N];
        for (taxel, channel) in self.taxels() {
            let set = self.configure(channel, oversampling).await;
            results[taxel] = match set {
                Ok(()) => Ok(()),
                Err(error) => Err(self.fault_of(taxel, channel, error).await?),
            };
        }
        self.open(Channels::NONE).await?;
        self.is_ready = true;
        Ok(results)
    }

    /// Closes all channels. A frame under way is lost.
    ///
    /// # Errors
    /// [`Error::SwitchMissing`], [`Error::Bus`], [`Error::BusHung`].
    pub async fn stop(&mut self) -> Result<(), Error<I2C::Error>> {
        self.is_ready = false;
        self.triggered_us = None;
        self.open(Channels::NONE).await
    }

    /// Lends the bus to its owner, to free it after [`Error::BusHung`]: by [`recovery`](crate::recovery), or a way of the bus's own.
    ///
    /// Which taxels are isolated is not forgotten.
    pub fn recover<T>(&mut self, free: impl FnOnce(&mut I2C, &mut D) -> T) -> T {
        self.is_ready = false;
        self.triggered_us = None;
        free(&mut self.i2c, &mut self.delay)
    }

    /// Gives isolated taxels another chance. A taxel is isolated when the bus hung twice running with its channel alone open.
    pub const fn readmit(&mut self) {
        self.is_ready = false;
        self.suspect = None;
        self.isolated = Channels::NONE;
    }

    /// Changes [`Settings::conversion_us`], from the frame under way on.
    pub const fn set_conversion_us(&mut self, conversion_us: u32) {
        self.settings.conversion_us = conversion_us;
    }

    /// The taxels that are not isolated, and the channel of each.
    fn taxels(&self) -> impl Iterator<Item = (usize, Channels)> + use<I2C, D, C, N> {
        let isolated = self.isolated;
        let channels = self.settings.wiring.channels().into_iter().enumerate();
        channels.filter(move |(_, channel)| !isolated.contains(*channel))
    }

    fn switch(&mut self) -> Tca9548a<&mut I2C> {
        Tca9548a::new(&mut self.i2c, self.settings.switch)
    }

    fn barometer(&mut self) -> Cps135b<&mut I2C> {
        Cps135b::new(&mut self.i2c)
    }

    /// Triggers all barometers with one write, and says when.
    async fn broadcast(&mut self) -> Result<u64, Error<I2C::Error>> {
        if !self.is_ready {
            self.start().await?;
        }
        self.is_ready = false;
        let channels = self.settings.wiring.all().without(self.isolated);
        self.open(channels).await?;
        match self.barometer().trigger().await {
            Ok(()) => {}
            Err(Error::BarometerMissing) => {
                self.switch().verify(channels).await?;
                return Err(Error::NotTriggered);
            }
            Err(Error::Bus(source)) => return Err(self.bus_error(None, source).await),
            Err(error) => return Err(error),
        }
        self.is_ready = true;
        Ok(self.clock.now_us())
    }

    /// Opens channels.
    async fn open(&mut self, channels: Channels) -> Result<(), Error<I2C::Error>> {
        match self.switch().select(channels).await {
            Err(Error::Bus(source)) => Err(self.bus_error(None, source).await),
            result => result,
        }
    }

    /// Opens one channel, and sees that the switch obeys and the bus still works.
    async fn probe(&mut self, channel: Channels) -> Result<(), Error<I2C::Error>> {
        self.switch().select(channel).await?;
        self.switch().verify(channel).await?;
        self.barometer().is_converting().await?;
        Ok(())
    }

    /// Reads one taxel.
    async fn read(
        &mut self,
        channel: Channels,
        patience: &mut Patience,
    ) -> Result<Sample, Error<I2C::Error>> {
        self.switch().select(channel).await?;
        Cps135b::new(&mut self.i2c)
            .finish(&mut self.delay, patience)
            .await
    }

    /// Sets the oversampling of one taxel.
    async fn configure(
        &mut self,
        channel: Channels,
        oversampling: Oversampling,
    ) -> Result<(), Error<I2C::Error>> {
        self.switch().select(channel).await?;
        self.barometer().set_oversampling(oversampling).await
    }

    /// What an error met with one channel open says of its taxel, unless it says more.
    async fn fault_of(
        &mut self,
        taxel: usize,
        channel: Channels,
        error: Error<I2C::Error>,
    ) -> Result<Fault, Error<I2C::Error>> {
        match error {
            Error::BarometerMissing => {
                self.switch().verify(channel).await?; // nobody answers either if the channel is closed
                Ok(Fault::Missing)
            }
            Error::ConversionStuck => Ok(Fault::Stuck),
            Error::OversamplingRefused { .. } => Ok(Fault::Refused),
            Error::Bus(source) => {
                let kind = source.kind();
                match self.bus_error(Some(taxel), source).await {
                    Error::Bus(_) => Ok(Fault::Bus(kind)),
                    error => Err(error),
                }
            }
            error => Err(error),
        }
    }

    /// Whether the bus works with all channels closed, after it failed.
    async fn bus_error(&mut self, taxel: Option<usize>, source: I2C::Error) -> Error<I2C::Error> {
        if self.switch().select(Channels::NONE).await.is_ok() {
            return Error::Bus(source);
        }
        if let Some(taxel) = taxel {
            if self.suspect == Some(taxel) {
                self.isolated = self.isolated | self.settings.wiring.channels()[taxel];
            }
            self.suspect = Some(taxel);
        }
        Error::BusHung { taxel, source }
    }
}
