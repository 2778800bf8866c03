//! The sensor: all barometers at once.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use super::Tca9548a;
use crate::channels::{Channels, SwitchAddress};
use crate::chip::{AnyDriver, Command, Conversion, Progress};
use crate::clock::Clock;
use crate::error::Error;
use crate::fault::Fault;
use crate::frame::Frame;
use crate::line::Line;
use crate::patience::Patience;
use crate::settings::Settings;
use crate::taxels::Taxels;
use crate::wiring::Place;

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
pub struct PhysTac<I2C, D, C, const N: usize> {
    i2c: I2C,
    delay: D,
    clock: C,
    pub(super) settings: Settings<N>,
    /// Of chips that are switched on.
    drivers: [Option<AnyDriver>; N],
    /// Switches that may have channels open.
    open: [bool; 8],
    /// Whether the last operation on the bus came to its end.
    is_ready: bool,
    /// When the frame under way was triggered.
    triggered_us: Option<u64>,
    /// Frames since the sensor was switched on.
    frames: u32,
    /// Taxels that failed: asked before the next trigger.
    doubtful: Taxels,
    /// Why taxels have no part in the frame under way.
    left_out: [Option<Fault>; N],
    /// The taxel with whose channel open the bus hung last.
    pub(super) suspect: Option<usize>,
    /// Taxels whose channel hung the bus twice running.
    pub(super) isolated: Taxels,
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

/// In how many frames temperature is converted once, where it is converted apart.
pub(crate) const FRAMES_PER_TEMPERATURE: u32 = 16;

/// A taxel and where it is.
#[derive(Clone, Copy)]
pub(super) struct Taxel {
    pub(super) index: usize,
    pub(super) place: Place,
}

impl<I2C, D, C, const N: usize> PhysTac<I2C, D, C, N> {
    /// The sensor on a bus. Nothing is sent yet.
    pub const fn new(i2c: I2C, delay: D, clock: C, settings: Settings<N>) -> Self {
        Self {
            i2c,
            delay,
            clock,
            settings,
            drivers: [None; N],
            open: [false; 8],
            is_ready: false,
            triggered_us: None,
            frames: 0,
            doubtful: Taxels::NONE,
            left_out: [None; N],
            suspect: None,
            isolated: Taxels::NONE,
            retries: [Retry {
                at_us: None,
                wait_us: 0,
            }; N],
        }
    }

    /// How it is wired and timed.
    #[must_use]
    pub const fn settings(&self) -> &Settings<N> {
        &self.settings
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
        self.isolated = Taxels::NONE;
    }

    /// Changes [`Settings::conversion_us`], from the frame under way on.
    pub const fn set_conversion_us(&mut self, conversion_us: u32) {
        self.settings.conversion_us = conversion_us;
    }

    /// The taxels that are not isolated.
    fn taxels(&self) -> impl Iterator<Item = Taxel> + use<I2C, D, C, N> {
        let (isolated, wiring) = (self.isolated, self.settings.wiring);
        let all = (0..N).filter_map(move |index| {
            Some(Taxel {
                index,
                place: wiring.place(index)?,
            })
        });
        all.filter(move |taxel| !isolated.contains(taxel.index))
    }

    /// Those of them that take part in the frame under way, with what starts their conversion.
    fn converting(&self, conversion: Conversion) -> impl Iterator<Item = (Taxel, Command)> + '_ {
        self.taxels().filter_map(move |taxel| {
            let is_out = self.left_out[taxel.index].is_some() || self.doubtful.contains(taxel.index);
            let driver = self.drivers[taxel.index].filter(|_| !is_out)?;
            Some((taxel, driver.command(conversion)?))
        })
    }

    /// The longest that a conversion takes, µs. `None`: there is none.
    fn longest_us(&self, conversion: Conversion) -> Option<u32> {
        let times = self
            .converting(conversion)
            .map(|(_, command)| command.conversion_us);
        times.map(|us| us.unwrap_or(self.settings.conversion_us)).max()
    }
}

impl<I2C: I2c, D, C, const N: usize> PhysTac<I2C, D, C, N> {
    pub(super) const fn i2c_mut(&mut self) -> &mut I2C {
        &mut self.i2c
    }

    /// Takes all taxels on a channel out.
    pub(super) fn isolate(&mut self, behind: Option<(SwitchAddress, Channels)>) {
        for taxel in self.taxels().filter(|taxel| taxel.place.behind == behind) {
            self.isolated.insert(taxel.index);
        }
    }

    pub(super) fn switch(&mut self, address: SwitchAddress) -> Tca9548a<&mut I2C> {
        Tca9548a::new(&mut self.i2c, address)
    }

    /// Opens channels of one switch and closes all others.
    async fn open_at(&mut self, switch: SwitchAddress, channels: Channels) -> Result<(), Error<I2C::Error>> {
        self.close_but(Some(switch)).await?;
        self.open[number(switch)] = true;
        self.switch(switch).select(channels).await
    }

    /// Closes the channels of switches that may have any open, but of this one.
    async fn close_but(&mut self, kept: Option<SwitchAddress>) -> Result<(), Error<I2C::Error>> {
        for switch in self.settings.wiring.switches() {
            if self.open[number(switch)] && kept != Some(switch) {
                self.switch(switch).select(Channels::NONE).await?;
                self.open[number(switch)] = false;
            }
        }
        Ok(())
    }

    /// Opens the channel of one taxel, and closes all others.
    async fn open(&mut self, place: Place) -> Result<(), Error<I2C::Error>> {
        match place.behind {
            Some((switch, channel)) => self.open_at(switch, channel).await,
            None => self.close_but(None).await,
        }
    }

    /// Closes the channels of all switches, whatever is thought of them.
    pub(super) async fn close(&mut self) -> Result<(), Error<I2C::Error>> {
        self.open = [true; 8];
        self.close_but(None).await
    }

    async fn close_or_diagnose(&mut self) -> Result<(), Error<I2C::Error>> {
        let closed = self.close().await;
        self.diagnose(None, closed).await
    }

    /// Makes sure that these channels of a switch are open.
    async fn verify(&mut self, switch: SwitchAddress, channels: Channels) -> Result<(), Error<I2C::Error>> {
        let verified = self.switch(switch).verify(channels).await;
        self.diagnose(None, verified).await
    }

    /// With all channels closed, nobody may answer where barometers behind switches do.
    async fn look_for_conflicts(&mut self) -> Result<(), Error<I2C::Error>> {
        let hidden = |place: Place| place.behind.is_some();
        for taxel in self.taxels().filter(|taxel| hidden(taxel.place)) {
            let address = taxel.place.address;
            let is_seen = |before: Taxel| hidden(before.place) && before.place.address == address;
            if self
                .taxels()
                .take_while(|before| before.index < taxel.index)
                .any(is_seen)
            {
                continue;
            }
            let mut byte = [0];
            let read = self.i2c.read(address, &mut byte).await;
            match read.map_err(|source| Error::of_transaction(source, Error::BarometerMissing)) {
                Ok(()) => return Err(Error::AddressConflict { address }),
                Err(Error::BarometerMissing) => {}
                failed => self.diagnose(None, failed).await?,
            }
        }
        Ok(())
    }
}

impl<I2C: I2c, D: DelayNs, C: Clock, const N: usize> PhysTac<I2C, D, C, N> {
    /// Closes all channels, sees that the switches obey and that nothing else has a barometer's address, looks into each channel alone, switches
    /// the barometers on, and lets conversions under way end.
    ///
    /// The other operations do so by themselves when needed.
    ///
    /// # Errors
    /// Any but those of a single barometer; [`Error::AddressConflict`]; [`Error::BusHung`] with the taxel, if opening its channel hangs the bus.
    pub async fn start(&mut self) -> Result<(), Error<I2C::Error>> {
        self.is_ready = false;
        self.triggered_us = None;
        self.close_or_diagnose().await?;
        for switch in self.settings.wiring.switches() {
            self.verify(switch, Channels::NONE).await?;
        }
        self.look_for_conflicts().await?;
        self.doubtful = Taxels::NONE;
        self.left_out = [None; N];
        let mut patience = self.settings.patience;
        let longest_us = self
            .longest_us(Conversion::Pressure)
            .unwrap_or(self.settings.conversion_us);
        let n_conversion = longest_us.div_ceil(patience.interval_us.max(1));
        patience.waits = patience.waits.saturating_add(n_conversion);
        for taxel in self.taxels() {
            if let Err(error) = self.probe(taxel, &mut patience).await {
                self.fault_of(taxel, error).await?;
                self.drivers[taxel.index] = None;
                self.doubtful.insert(taxel.index);
            }
        }
        self.close_or_diagnose().await?;
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
        let longest_us = self.longest_us(Conversion::Pressure).unwrap_or_default();
        self.delay.delay_us(longest_us.saturating_sub(passed_us)).await;

        let mut frame = Frame {
            triggered_us,
            read_us: [triggered_us; N],
            taxels: [Err(Fault::NotWired); N],
        };
        for (index, _) in self.settings.wiring.taxels().enumerate() {
            frame.taxels[index] = Err(self.left_out[index].unwrap_or(Fault::Isolated));
        }
        let mut patience = self.settings.patience;
        self.collect(Conversion::Pressure, &mut frame, &mut patience)
            .await?;
        let frames = self.frames;
        self.frames = frames.wrapping_add(1);
        if frames.is_multiple_of(FRAMES_PER_TEMPERATURE)
            && let Some(longest_us) = self.longest_us(Conversion::Temperature)
        {
            self.tell(Conversion::Temperature).await?;
            self.delay.delay_us(longest_us).await;
            self.collect(Conversion::Temperature, &mut frame, &mut patience)
                .await?;
        }
        self.is_ready = true;
        self.suspect = None;
        Ok(frame)
    }

    /// Closes all channels. A frame under way is lost.
    ///
    /// # Errors
    /// [`Error::SwitchMissing`], [`Error::Bus`], [`Error::BusHung`].
    pub async fn stop(&mut self) -> Result<(), Error<I2C::Error>> {
        self.is_ready = false;
        self.triggered_us = None;
        self.close_or_diagnose().await
    }

    /// Triggers all barometers that can be, and says when.
    async fn broadcast(&mut self) -> Result<u64, Error<I2C::Error>> {
        if !self.is_ready {
            self.start().await?;
        }
        self.is_ready = false;
        self.look_again().await?;
        self.left_out = [None; N];
        let doubtful = core::mem::take(&mut self.doubtful);
        for taxel in self.taxels().filter(|taxel| doubtful.contains(taxel.index)) {
            if let Err(error) = self.ask(taxel).await {
                self.leave_out(taxel, error).await?;
            }
        }
        if !self.tell(Conversion::Pressure).await? {
            return Err(Error::NotTriggered);
        }
        self.is_ready = true;
        Ok(self.clock.now_us())
    }

    /// Starts conversions, with one write for all barometers that need the same bytes at the same address. Whether any took it.
    async fn tell(&mut self, conversion: Conversion) -> Result<bool, Error<I2C::Error>> {
        let mut told = Taxels::NONE;
        let mut is_taken = false;
        loop {
            let next = self
                .converting(conversion)
                .find(|(taxel, _)| !told.contains(taxel.index));
            let Some((first, command)) = next else { break };
            let mut group = Taxels::NONE;
            for (taxel, its_command) in self.converting(conversion) {
                if taxel.place.address == first.place.address && its_command == command {
                    group.insert(taxel.index);
                    told.insert(taxel.index);
                }
            }
            let opened = self.open_group(group).await;
            self.diagnose(None, opened).await?;
            let written = self.i2c.write(first.place.address, command.bytes()).await;
            match written.map_err(|source| Error::of_transaction(source, Error::BarometerMissing)) {
                Err(Error::BarometerMissing) => {
                    self.verify_group(group).await?; // if their channels are closed, nobody answers either
                    for taxel in self.taxels().filter(|taxel| group.contains(taxel.index)) {
                        self.left_out[taxel.index] = Some(Fault::Missing);
                        self.drivers[taxel.index] = None;
                        self.doubtful.insert(taxel.index);
                    }
                }
                written => {
                    self.diagnose(None, written).await?;
                    is_taken = true;
                }
            }
        }
        Ok(is_taken)
    }

    /// The channels of a switch that taxels of a group are on.
    fn channels_of(&self, group: Taxels, switch: SwitchAddress) -> Channels {
        let places = self.taxels().filter(|taxel| group.contains(taxel.index));
        let behind = places.filter_map(|taxel| taxel.place.behind);
        let here = behind.filter(|(other, _)| *other == switch);
        here.fold(Channels::NONE, |all, (_, channel)| all | channel)
    }

    /// Opens the channels of a group's taxels, and closes all others.
    async fn open_group(&mut self, group: Taxels) -> Result<(), Error<I2C::Error>> {
        for switch in self.settings.wiring.switches() {
            let channels = self.channels_of(group, switch);
            let is_none = channels == Channels::NONE;
            if is_none && !self.open[number(switch)] {
                continue;
            }
            self.open[number(switch)] = true;
            self.switch(switch).select(channels).await?;
            self.open[number(switch)] = !is_none;
        }
        Ok(())
    }

    async fn verify_group(&mut self, group: Taxels) -> Result<(), Error<I2C::Error>> {
        for switch in self.settings.wiring.switches() {
            let channels = self.channels_of(group, switch);
            if channels != Channels::NONE {
                self.verify(switch, channels).await?;
            }
        }
        Ok(())
    }

    /// Reads what conversions gave, one taxel after the other.
    async fn collect(
        &mut self,
        conversion: Conversion,
        frame: &mut Frame<N>,
        patience: &mut Patience,
    ) -> Result<(), Error<I2C::Error>> {
        for index in 0..N {
            let taxel = self.converting(conversion).map(|(taxel, _)| taxel);
            let Some(taxel) = { taxel }.find(|taxel| taxel.index == index) else {
                continue;
            };
            let read = self.read(taxel, conversion, patience).await;
            frame.read_us[index] = self.clock.now_us();
            frame.taxels[index] = match read {
                Ok(driver) => Ok(driver.sample()),
                Err(error) => Err(self.leave_out(taxel, error).await?),
            };
        }
        Ok(())
    }

    /// Leaves a taxel out, for what an error says of it.
    async fn leave_out(
        &mut self,
        taxel: Taxel,
        error: Error<I2C::Error>,
    ) -> Result<Fault, Error<I2C::Error>> {
        self.drivers[taxel.index] = None;
        self.doubtful.insert(taxel.index);
        let fault = self.fault_of(taxel, error).await?;
        self.left_out[taxel.index] = Some(fault);
        Ok(fault)
    }

    /// Looks into isolated channels whose time has come: one that does not hang the bus any more takes part again.
    async fn look_again(&mut self) -> Result<(), Error<I2C::Error>> {
        let first_us = u64::from(self.settings.retry_us);
        for index in 0..N {
            let Some(place) = self.settings.wiring.place(index) else {
                break;
            };
            if !self.isolated.contains(index) {
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
            let taxel = Taxel { index, place };
            let fault = match self.ask(taxel).await {
                Ok(()) => None,
                Err(error) => Some(self.fault_of(taxel, error).await?),
            };
            if !matches!(fault, Some(Fault::Bus(_))) {
                self.isolated.remove(index);
                self.doubtful.insert(index);
            }
        }
        Ok(())
    }

    /// Sees that the switch obeys and that the bus works with one channel open, and waits for its barometer.
    async fn probe(&mut self, taxel: Taxel, patience: &mut Patience) -> Result<(), Error<I2C::Error>> {
        self.open(taxel.place).await?;
        if let Some((switch, channel)) = taxel.place.behind {
            self.switch(switch).verify(channel).await?;
        }
        self.settle(taxel, patience).await
    }

    /// Asks the barometer of one taxel whether it still converts, and switches it on if it has to be.
    async fn ask(&mut self, taxel: Taxel) -> Result<(), Error<I2C::Error>> {
        self.open(taxel.place).await?;
        let mut patience = Patience {
            waits: 0,
            ..self.settings.patience
        };
        self.settle(taxel, &mut patience).await
    }

    /// Waits until the barometer whose channel is open converts no more; switches it on before if it is not.
    async fn settle(&mut self, taxel: Taxel, patience: &mut Patience) -> Result<(), Error<I2C::Error>> {
        let Place { chip, address, .. } = taxel.place;
        let mut line = Line::new(&mut self.i2c, &mut self.delay, address, patience);
        let Some(driver) = self.drivers[taxel.index] else {
            let speed = self.settings.wiring.speed(taxel.index);
            self.drivers[taxel.index] = Some(AnyDriver::start(chip, speed, &mut line).await?);
            return Ok(());
        };
        while driver.is_busy(&mut line).await? {
            line.wait().await?;
        }
        Ok(())
    }

    /// Reads the barometer of one taxel, once it has ended.
    async fn read(
        &mut self,
        taxel: Taxel,
        conversion: Conversion,
        patience: &mut Patience,
    ) -> Result<AnyDriver, Error<I2C::Error>> {
        self.open(taxel.place).await?;
        let mut line = Line::new(&mut self.i2c, &mut self.delay, taxel.place.address, patience);
        let driver = self.drivers[taxel.index].as_mut().ok_or(Error::ConversionStuck)?;
        while driver.collect(conversion, &mut line).await? == Progress::Converting {
            line.wait().await?;
        }
        Ok(*driver)
    }
}

/// Which of the eight switches that a bus can have, from 0.
fn number(switch: SwitchAddress) -> usize {
    usize::from(switch.get() - SwitchAddress::FIRST)
}
