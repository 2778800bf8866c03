//! The sensor: all barometers at once.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

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
/// own channel, until it has ended, and read. What goes wrong with one taxel is that taxel's [`Fault`] and stops no other. One that failed in
/// a frame is asked before the next trigger, and left out of the frame if it is still converting or fails again: its sample would be of
/// an earlier moment than the frame says.
///
/// After an [`Error`] nothing is taken for granted: the next call closes all channels, sees that the switch obeys, and looks into each
/// channel before any broadcast.
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
    /// Channels that failed: asked before the next trigger.
    doubtful: Channels,
    /// Why taxels have no part in the frame under way.
    left_out: [Option<Fault>; N],
    /// The taxel with whose channel open the bus hung last.
    pub(super) suspect: Option<usize>,
    /// Channels that hung the bus twice running.
    pub(super) isolated: Channels,
    /// When taxels that are isolated are looked into again.
    retries: [Retry; N],
}

/// When a channel that hung the bus is looked into again.
#[derive(Clone, Copy, Debug)]
struct Retry {
    /// When, µs of the clock; not known yet if `None`.
    at_us: Option<u64>,
    /// How long it is closed before, µs.
    wait_us: u64,
}

/// The longest that a channel is closed, over the first time.
const LONGEST_WAIT: u64 = 64;

/// A taxel and the channel that it is on.
#[derive(Clone, Copy)]
pub(super) struct Taxel {
    pub(super) index: usize,
    pub(super) channel: Channels,
}

impl<I2C, D, C, const N: usize> PhysTac<I2C, D, C, N> {
    /// The sensor on a bus. Nothing is sent yet.
    pub const fn new(i2c: I2C, delay: D, clock: C, settings: Settings<N>) -> Self {
        Self {
            i2c,
            delay,
            clock,
            settings,
            is_ready: false,
            triggered_us: None,
            doubtful: Channels::NONE,
            left_out: [None; N],
            suspect: None,
            isolated: Channels::NONE,
            retries: [Retry {
                at_us: None,
                wait_us: 0,
            }; N],
        }
    }

    /// Gives the bus, the delay and the clock back. Channels stay open unless [`stop`](Self::stop) closed them.
    pub fn release(self) -> (I2C, D, C) {
        (self.i2c, self.delay, self.clock)
    }

    /// Lends the bus to its owner, to free it after [`Error::BusHung`]: by [`recovery`](crate::recovery), or a way of the bus's own.
    ///
    /// Which taxels are isolated is not forgotten.
    pub fn recover<T>(&mut self, free: impl FnOnce(&mut I2C, &mut D) -> T) -> T {
        self.is_ready = false;
        self.triggered_us = None;
        free(&mut self.i2c, &mut self.delay)
    }

    /// Gives isolated taxels another chance at once. A taxel is isolated when the bus hung twice running with its channel alone open, and is looked
    /// into again by itself after [`Settings::retry_us`].
    pub const fn readmit(&mut self) {
        self.is_ready = false;
        self.suspect = None;
        self.isolated = Channels::NONE;
    }

    /// Changes [`Settings::conversion_us`], from the frame under way on.
    pub const fn set_conversion_us(&mut self, conversion_us: u32) {
        self.settings.conversion_us = conversion_us;
    }

    /// The taxels that are not isolated.
    fn taxels(&self) -> impl Iterator<Item = Taxel> + use<I2C, D, C, N> {
        let isolated = self.isolated;
        let channels = self.settings.wiring.channels().into_iter().enumerate();
        let taxels = channels.map(|(index, channel)| Taxel { index, channel });
        taxels.filter(move |taxel| !isolated.contains(taxel.channel))
    }
}

impl<I2C: I2c, D, C, const N: usize> PhysTac<I2C, D, C, N> {
    pub(super) fn switch(&mut self) -> Tca9548a<&mut I2C> {
        Tca9548a::new(&mut self.i2c, self.settings.switch)
    }

    fn barometer(&mut self) -> Cps135b<&mut I2C> {
        Cps135b::new(&mut self.i2c)
    }

    /// Opens channels.
    async fn open(&mut self, channels: Channels) -> Result<(), Error<I2C::Error>> {
        let opened = self.switch().select(channels).await;
        self.diagnose(None, opened).await
    }

    /// Makes sure that channels are open.
    async fn verify(&mut self, channels: Channels) -> Result<(), Error<I2C::Error>> {
        let verified = self.switch().verify(channels).await;
        self.diagnose(None, verified).await
    }
}

impl<I2C: I2c, D: DelayNs, C: Clock, const N: usize> PhysTac<I2C, D, C, N> {
    /// Closes all channels, sees that the switch obeys, looks into each channel alone, and lets conversions under way end.
    ///
    /// The other operations do so by themselves when needed.
    ///
    /// # Errors
    /// Any but those of a single barometer; [`Error::BusHung`] with the taxel, if opening its channel hangs the bus.
    pub async fn start(&mut self) -> Result<(), Error<I2C::Error>> {
        self.is_ready = false;
        self.triggered_us = None;
        self.open(Channels::NONE).await?;
        self.verify(Channels::NONE).await?;
        let mut patience = self.settings.patience;
        let n_conversion = self.settings.conversion_us.div_ceil(patience.interval_us.max(1));
        patience.waits = patience.waits.saturating_add(n_conversion);
        self.doubtful = Channels::NONE;
        for taxel in self.taxels() {
            if let Err(error) = self.probe(taxel.channel, &mut patience).await {
                self.fault_of(taxel, error).await?;
                self.doubtful = self.doubtful | taxel.channel;
            }
        }
        self.open(Channels::NONE).await?;
        self.is_ready = true;
        Ok(())
    }

    /// Triggers the next frame, unless one is under way. Right after [`frame`](Self::frame) the barometers convert while the caller computes.
    ///
    /// # Errors
    /// [`Error::NotTriggered`], and those of [`start`](Self::start).
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
        let left_us = self.settings.conversion_us.saturating_sub(passed_us);
        self.delay.delay_us(left_us).await;

        let mut frame = Frame {
            triggered_us,
            read_us: [triggered_us; N],
            taxels: [Err(Fault::Isolated); N],
        };
        let mut patience = self.settings.patience;
        for taxel in self.taxels() {
            if let Some(fault) = self.left_out[taxel.index] {
                frame.taxels[taxel.index] = Err(fault);
                continue;
            }
            let read = self.read(taxel.channel, &mut patience).await;
            frame.read_us[taxel.index] = self.clock.now_us();
            frame.taxels[taxel.index] = match read {
                Ok(sample) => Ok(sample),
                Err(error) => {
                    self.doubtful = self.doubtful | taxel.channel;
                    Err(self.fault_of(taxel, error).await?)
                }
            };
        }
        self.is_ready = true;
        self.suspect = None;
        Ok(frame)
    }

    /// Sets the oversampling of each barometer, until it loses power. More samples take longer: let
    /// [`set_conversion_us`](Self::set_conversion_us) follow.
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
        for taxel in self.taxels() {
            let set = self.configure(taxel.channel, oversampling).await;
            results[taxel.index] = match set {
                Ok(()) => Ok(()),
                Err(error) => Err(self.fault_of(taxel, error).await?),
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

    /// Triggers all barometers that can be with one write, and says when.
    async fn broadcast(&mut self) -> Result<u64, Error<I2C::Error>> {
        if !self.is_ready {
            self.start().await?;
        }
        self.is_ready = false;
        self.look_again().await?;
        self.left_out = [None; N];
        let doubtful = core::mem::take(&mut self.doubtful);
        for taxel in self.taxels().filter(|taxel| doubtful.contains(taxel.channel)) {
            if let Err(error) = self.ask(taxel.channel).await {
                self.left_out[taxel.index] = Some(self.fault_of(taxel, error).await?);
                self.doubtful = self.doubtful | taxel.channel;
            }
        }
        let channels = self.settings.wiring.all().without(self.isolated | self.doubtful);
        self.open(channels).await?;
        match self.barometer().trigger().await {
            Err(Error::BarometerMissing) => {
                self.verify(channels).await?; // if they are closed, nobody answers either
                return Err(Error::NotTriggered);
            }
            triggered => self.diagnose(None, triggered).await?,
        }
        self.is_ready = true;
        Ok(self.clock.now_us())
    }

    /// Looks into isolated channels whose time has come: one that does not hang the bus any more takes part again.
    async fn look_again(&mut self) -> Result<(), Error<I2C::Error>> {
        let first_us = u64::from(self.settings.retry_us);
        for (index, channel) in self.settings.wiring.channels().into_iter().enumerate() {
            if !self.isolated.contains(channel) {
                self.retries[index].at_us = None;
                continue;
            }
            let now_us = self.clock.now_us();
            let retry = &mut self.retries[index];
            let is_due = retry.at_us.is_some_and(|at_us| at_us <= now_us);
            if retry.at_us.is_some() && !is_due {
                continue;
            }
            // The next time is set before the bus may hang again.
            let twice_us = 2 * retry.wait_us.max(first_us);
            retry.wait_us = match is_due {
                true => twice_us.min(LONGEST_WAIT * first_us),
                false => retry.wait_us.max(first_us),
            };
            retry.at_us = Some(now_us.saturating_add(retry.wait_us));
            if !is_due {
                continue;
            }
            let taxel = Taxel { index, channel };
            let fault = match self.ask(channel).await {
                Ok(()) => None,
                Err(error) => Some(self.fault_of(taxel, error).await?),
            };
            if !matches!(fault, Some(Fault::Bus(_))) {
                self.isolated = self.isolated.without(channel);
                self.doubtful = self.doubtful | channel;
            }
        }
        Ok(())
    }

    /// Sees that the switch obeys and that the bus works with one channel open, and waits for its barometer.
    async fn probe(&mut self, channel: Channels, patience: &mut Patience) -> Result<(), Error<I2C::Error>> {
        self.switch().select(channel).await?;
        self.switch().verify(channel).await?;
        self.wait(patience).await
    }

    /// Asks the barometer of one channel whether it still converts.
    async fn ask(&mut self, channel: Channels) -> Result<(), Error<I2C::Error>> {
        self.switch().select(channel).await?;
        let mut patience = Patience {
            waits: 0,
            ..self.settings.patience
        };
        self.wait(&mut patience).await
    }

    /// Reads the barometer of one channel.
    async fn read(
        &mut self,
        channel: Channels,
        patience: &mut Patience,
    ) -> Result<Sample, Error<I2C::Error>> {
        self.switch().select(channel).await?;
        self.wait(patience).await?;
        self.barometer().sample().await
    }

    /// Sets the oversampling of one channel's barometer.
    async fn configure(
        &mut self,
        channel: Channels,
        oversampling: Oversampling,
    ) -> Result<(), Error<I2C::Error>> {
        self.ask(channel).await?;
        self.barometer().set_oversampling(oversampling).await
    }

    /// Waits for the barometer whose channel is open.
    async fn wait(&mut self, patience: &mut Patience) -> Result<(), Error<I2C::Error>> {
        Cps135b::new(&mut self.i2c).wait(&mut self.delay, patience).await
    }
}
