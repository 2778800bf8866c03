//! A sensor's rounds of readings.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;
use phystac::asynch::PhysTac;
use phystac::recovery::RecoveryError;
use phystac::{Budget, Clock, Error, Frame, FreeAir, Transfer, scale_hint};

use crate::back_off::BackOff;
use crate::bounded::{Bounded, BoundedError};
use crate::command::Rate;
use crate::pace::Pace;
use crate::report::{Report, needs_scale};
use crate::settings::NodeSettings;
use crate::trouble::Trouble;

/// Reads `N` barometers in rounds, and goes on whatever happens to them or to the bus.
///
/// A round triggers all chips with one write, waits, and reads each; [`phystac`] tells how, and in every sixteenth round reads temperatures
/// that are converted apart. What goes wrong with one taxel stands in its report. When the whole round fails, `rescue` frees the bus: it
/// resets the switches, and gives nine clocks where a board can. Failures that follow each other are left alone for 10 ms, then for twice
/// as long, up to a second; each is reported.
#[derive(Debug)]
pub struct Node<I2C, D, C, R, const N: usize> {
    sensor: PhysTac<Bounded<I2C, D>, D, C, N>,
    delay: D,
    clock: C,
    rescue: R,
    settings: NodeSettings<N>,
    pace: Pace,
    back_off: BackOff,
    /// No round before, µs of the clock.
    not_before_us: u64,
    sequence: u32,
    rescues: u16,
    /// What the trigger of the round ahead said.
    failed: Option<Trouble>,
    /// The scale that free air speaks for.
    hint: Option<u16>,
}

impl<I2C, D, C, R, const N: usize> Node<I2C, D, C, R, N>
where
    I2C: I2c,
    D: DelayNs + Clone,
    C: Clock + Clone,
    R: FnMut(&mut I2C) -> Result<(), RecoveryError>,
{
    /// A node on a bus. Nothing is sent yet. `clock` counts µs since the board was switched on; `rescue` frees the bus, with the switches' RESET.
    pub fn new(bus: I2C, delay: D, clock: C, rescue: R, settings: NodeSettings<N>) -> Self {
        let bounded = Bounded::new(bus, delay.clone(), settings.transaction_us);
        Self {
            sensor: PhysTac::new(bounded, delay.clone(), clock.clone(), settings.sensor),
            delay,
            clock,
            rescue,
            settings,
            pace: Pace::new(settings.period_us),
            back_off: BackOff::default(),
            not_before_us: 0,
            sequence: 0,
            rescues: 0,
            failed: None,
            hint: None,
        }
    }

    /// How it reads.
    pub const fn settings(&self) -> &NodeSettings<N> {
        &self.settings
    }

    /// The scale that the last round speaks for, if its chips only count and nothing touched them: counts per Pa.
    pub const fn hint(&self) -> Option<u16> {
        self.hint
    }

    /// The most rounds a second that the bus and the chips allow, Hz.
    pub(crate) fn most_hz(&self) -> f32 {
        Budget::new(&self.settings.sensor, self.settings.bus_hz).rate_hz()
    }

    /// From the next round on, so many a second.
    pub(crate) const fn set_rate(&mut self, rate: Rate) {
        self.settings.period_us = match rate {
            Rate::Max | Rate::Hz(0) => 0,
            Rate::Hz(hz) => 1_000_000 / hz as u32,
        };
        self.pace = Pace::new(self.settings.period_us);
    }

    /// From the next round on, counts stand for so many to a Pa.
    pub(crate) const fn set_scale(&mut self, counts_per_pa: u16) {
        self.settings.transfer = Some(Transfer::per_pa(counts_per_pa));
    }

    /// Switches all chips on anew before the next round, and looks into channels that are kept closed.
    pub async fn restart(&mut self) {
        self.sensor.readmit();
        self.failed = match self.sensor.start().await {
            Ok(()) => None,
            Err(error) => Some(Trouble::from(&error)),
        };
        self.back_off.succeed();
        self.not_before_us = 0;
    }

    /// The next round, when its time has come. Ends with the trigger of the one after it, if rounds follow each other at once: the chips convert
    /// while the report is sent.
    pub async fn round(&mut self) -> Report<N> {
        let now_us = self.clock.now_us();
        let wait_us = self.pace.turn(now_us);
        let wait_us = wait_us.max(self.not_before_us.saturating_sub(now_us));
        if wait_us > 0 {
            self.delay
                .delay_us(u32::try_from(wait_us).unwrap_or(u32::MAX))
                .await;
        }
        let begun_us = self.clock.now_us();
        let sequence = self.sequence;
        self.sequence = sequence.wrapping_add(1);
        let result = match self.failed.take() {
            Some(trouble) => Err(trouble),
            None => self.sensor.frame().await.map_err(trouble_of),
        };
        match result {
            Ok(frame) => {
                self.back_off.succeed();
                self.look_for_scale(&frame);
                if self.pace.is_free() {
                    self.failed = self.sensor.trigger().await.map_err(trouble_of).err();
                }
                Report::of(&frame, self.settings.transfer.as_ref(), sequence, self.rescues)
            }
            Err(trouble) => {
                self.free(trouble);
                self.not_before_us = self.clock.now_us().saturating_add(self.back_off.fail());
                Report::failed(trouble, begun_us, sequence, self.rescues)
            }
        }
    }

    /// Frees the bus, if that may help. A pin that fails leaves it as it is: the next round says so.
    fn free(&mut self, trouble: Trouble) {
        if trouble.needs_rescue() {
            let rescue = &mut self.rescue;
            let _ = self.sensor.recover(|bounded, _| rescue(bounded.bus_mut()));
            self.rescues = self.rescues.saturating_add(1);
        }
    }

    fn look_for_scale(&mut self, frame: &Frame<N>) {
        let mut taxels = self.settings.sensor.wiring.taxels();
        let is_asked = self.settings.transfer.is_none() && taxels.any(|wired| needs_scale(wired.chip));
        self.hint = match is_asked {
            true => scale_hint(frame, FreeAir::default())
                .ok()
                .map(|hint| hint.counts_per_pa),
            false => None,
        };
    }
}

fn trouble_of<E>(error: Error<BoundedError<E>>) -> Trouble {
    Trouble::from(&error)
}
