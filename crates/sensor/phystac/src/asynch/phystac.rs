//! The sensor: all barometers of one bus.

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

/// Up to `N` barometers on an I²C bus, with or without switches, read as frames.
///
/// All barometers are triggered at the same moment: one write for all that take the same bytes at
/// the same address. Each barometer is then polled and read through its own channel. A failure of
/// one taxel is a [`Fault`] of that taxel; the other taxels have their values. A taxel that failed
/// is started again before the next trigger. It is left out of that frame if it still converts or
/// fails again, because its sample would be older than the frame.
///
/// Chips that convert temperature separately do so in every sixteenth frame, after the pressures.
/// The frames between use the last temperature.
///
/// After an [`Error`] the next call starts over: it closes all channels, checks that the switches
/// take their masks and that nothing else answers at the barometers' addresses, and opens each
/// channel alone before any write to several channels.
#[derive(Debug)]
pub struct PhysTac<I2C, D, C, const N: usize> {
    i2c: I2C,
    delay: D,
    clock: C,
    pub(super) settings: Settings<N>,
    /// The drivers of the chips that were started.
    drivers: [Option<AnyDriver>; N],
    /// Which switches may have channels open.
    open: [bool; 8],
    /// Whether the last operation on the bus ended normally.
    is_ready: bool,
    /// When the frame in progress was triggered, µs of the clock. `None`: no frame is in progress.
    triggered_us: Option<u64>,
    /// Number of frames read since the sensor was created.
    frames: u32,
    /// Taxels that failed. They are asked before the next trigger.
    doubtful: Taxels,
    /// Why taxels are left out of the frame in progress.
    left_out: [Option<Fault>; N],
    /// The taxel whose channel alone was open when the bus hung last.
    pub(super) suspect: Option<usize>,
    /// Taxels whose channel hung the bus twice in a row.
    pub(super) isolated: Taxels,
    /// When each isolated taxel is tried again.
    retries: [Retry; N],
}

/// When a channel that hung the bus is tried again.
#[derive(Clone, Copy, Debug)]
struct Retry {
    /// Time of the next try, µs of the clock. `None`: not set yet.
    at_us: Option<u64>,
    /// How long the channel stays closed before that try, µs.
    wait_us: u64,
}

/// The longest time that a channel stays closed, as a multiple of the first.
const LONGEST_WAIT: u64 = 64;

/// Number of frames for each temperature conversion, for chips that convert temperature separately.
pub(crate) const FRAMES_PER_TEMPERATURE: u32 = 16;

/// A taxel and its location.
#[derive(Clone, Copy)]
pub(super) struct Taxel {
    pub(super) index: usize,
    pub(super) place: Place,
}

impl<I2C, D, C, const N: usize> PhysTac<I2C, D, C, N> {
    /// A sensor on a bus. Sends nothing yet.
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

    /// Wiring and timing of the sensor.
    #[must_use]
    pub const fn settings(&self) -> &Settings<N> {
        &self.settings
    }

    /// Returns the bus, the delay and the clock. Channels stay open unless [`stop`](Self::stop)
    /// closed them.
    pub fn release(self) -> (I2C, D, C) {
        (self.i2c, self.delay, self.clock)
    }

    /// Lends the bus to the caller, to free it after [`Error::BusHung`], with
    /// [`recovery`](crate::recovery) or in another way that the bus offers.
    ///
    /// Isolated taxels stay isolated.
    pub fn recover<T>(&mut self, free: impl FnOnce(&mut I2C, &mut D) -> T) -> T {
        self.is_ready = false;
        self.triggered_us = None;
        free(&mut self.i2c, &mut self.delay)
    }

    /// Lets isolated taxels take part again at once. A taxel is isolated when the bus hung twice in
    /// a row while only its channel was open. Without this call the driver tries it again after
    /// [`Settings::retry_us`].
    pub const fn readmit(&mut self) {
        self.is_ready = false;
        self.suspect = None;
        self.isolated = Taxels::NONE;
    }

    /// Changes [`Settings::conversion_us`], starting with the frame in progress.
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

    /// The taxels that take part in the frame in progress, each with the command that starts its
    /// conversion.
    fn converting(&self, conversion: Conversion) -> impl Iterator<Item = (Taxel, Command)> + '_ {
        self.taxels().filter_map(move |taxel| {
            let is_out = self.left_out[taxel.index].is_some() || self.doubtful.contains(taxel.index);
            let driver = self.drivers[taxel.index].filter(|_| !is_out)?;
            Some((taxel, driver.command(conversion)?))
        })
    }

    /// The longest conversion time of these taxels, µs. `None`: no taxel converts.
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

    /// Isolates all taxels of a channel.
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

    /// Closes the channels of all switches that may have any open, except of this one.
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

    /// Closes the channels of all switches, whether they are known to be open or not.
    pub(super) async fn close(&mut self) -> Result<(), Error<I2C::Error>> {
        self.open = [true; 8];
        self.close_but(None).await
    }

    async fn close_or_diagnose(&mut self) -> Result<(), Error<I2C::Error>> {
        let closed = self.close().await;
        self.diagnose(None, closed).await
    }

    /// Checks that exactly these channels of a switch are open.
    async fn verify(&mut self, switch: SwitchAddress, channels: Channels) -> Result<(), Error<I2C::Error>> {
        let verified = self.switch(switch).verify(channels).await;
        self.diagnose(None, verified).await
    }

    /// Checks that nothing answers at the addresses of barometers behind switches while all
    /// channels are closed.
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
    /// Closes all channels; checks that the switches take their masks and that no other device has
    /// the address of a barometer behind a switch; opens each channel alone; starts the barometers;
    /// waits until conversions in progress have ended.
    ///
    /// The other operations call this when it is needed.
    ///
    /// # Errors
    /// Every error except those of a single barometer; [`Error::AddressConflict`];
    /// [`Error::BusHung`] with the taxel, if opening its channel hangs the bus.
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

    /// Triggers the next frame, unless one is in progress. Call it right after
    /// [`frame`](Self::frame): the barometers then convert while the caller computes.
    ///
    /// # Errors
    /// [`Error::NotTriggered`], and those of [`start`](Self::start).
    pub async fn trigger(&mut self) -> Result<(), Error<I2C::Error>> {
        if self.triggered_us.is_none() {
            self.triggered_us = Some(self.broadcast().await?);
        }
        Ok(())
    }

    /// Reads the frame in progress. Without one, triggers a frame first.
    ///
    /// # Errors
    /// Errors that concern all taxels; those of [`trigger`](Self::trigger). The frame in progress
    /// is lost.
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

    /// Closes all channels. A frame in progress is lost.
    ///
    /// # Errors
    /// [`Error::SwitchMissing`], [`Error::Bus`], [`Error::BusHung`].
    pub async fn stop(&mut self) -> Result<(), Error<I2C::Error>> {
        self.is_ready = false;
        self.triggered_us = None;
        self.close_or_diagnose().await
    }

    /// Triggers all barometers that can be triggered. Returns the time of the trigger, µs of the
    /// clock.
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

    /// Starts conversions, with one write for all barometers that take the same bytes at the same
    /// address. Returns whether any barometer acknowledged.
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
                    self.verify_group(group).await?; // with its channels closed, no barometer would acknowledge either
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

    /// The channels of a switch that have taxels of a group.
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

    /// Reads the results of a conversion, one taxel after the other.
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

    /// Leaves a taxel out of the frame, and returns the fault that follows from the error.
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

    /// Tries isolated channels whose waiting time has passed. A channel that no longer hangs the
    /// bus takes part again.
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

    /// Checks that the switch takes the mask and that the bus works with this channel open, then
    /// waits for the barometer.
    async fn probe(&mut self, taxel: Taxel, patience: &mut Patience) -> Result<(), Error<I2C::Error>> {
        self.open(taxel.place).await?;
        if let Some((switch, channel)) = taxel.place.behind {
            self.switch(switch).verify(channel).await?;
        }
        self.settle(taxel, patience).await
    }

    /// Asks the barometer of one taxel whether it still converts. Starts it if it is not started.
    async fn ask(&mut self, taxel: Taxel) -> Result<(), Error<I2C::Error>> {
        self.open(taxel.place).await?;
        let mut patience = Patience {
            waits: 0,
            ..self.settings.patience
        };
        self.settle(taxel, &mut patience).await
    }

    /// Waits until the barometer whose channel is open has ended its conversion. Starts it first if
    /// it is not started.
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

    /// Reads the barometer of one taxel once its conversion has ended.
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

/// The number of a switch, 0 to 7: a bus can have eight.
fn number(switch: SwitchAddress) -> usize {
    usize::from(switch.get() - SwitchAddress::FIRST)
}
