//! Rounds of readings of a sensor.

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

/// Reads `N` barometers in rounds, and continues after any failure of them or of the bus.
///
/// A round triggers all chips at the same moment, waits, and reads each chip with [`phystac`]. In
/// every sixteenth round it also reads temperatures that are converted separately. A fault of one
/// taxel is in its report. If the whole round fails, `rescue` frees the bus: it resets the
/// switches, and sends nine clocks if the board can. After failures in a row the node waits 10 ms,
/// then twice as long each time, up to one second. Each failure is reported.
#[derive(Debug)]
pub struct Node<I2C, D, C, R, const N: usize> {
    sensor: PhysTac<Bounded<I2C, D>, D, C, N>,
    delay: D,
    clock: C,
    rescue: R,
    settings: NodeSettings<N>,
    pace: Pace,
    back_off: BackOff,
    /// The next round starts no earlier than this, µs of the clock.
    not_before_us: u64,
    sequence: u32,
    rescues: u16,
    /// The failure of the trigger of the next round, if it failed.
    failed: Option<Trouble>,
    /// The scale at which the taxels read the pressure of free air, counts per Pa.
    hint: Option<u16>,
}

impl<I2C, D, C, R, const N: usize> Node<I2C, D, C, R, N>
where
    I2C: I2c,
    D: DelayNs + Clone,
    C: Clock + Clone,
    R: FnMut(&mut I2C) -> Result<(), RecoveryError>,
{
    /// A node on a bus. Sends nothing yet. `clock` counts µs since power-on. `rescue` frees the bus
    /// with the switches' RESET.
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

    /// The settings.
    pub const fn settings(&self) -> &NodeSettings<N> {
        &self.settings
    }

    /// The scale at which the taxels of the last round read the pressure of free air, counts per
    /// Pa. `None` if no scale is missing or no single scale fits. It is valid only if nothing
    /// touched the sensor.
    pub const fn hint(&self) -> Option<u16> {
        self.hint
    }

    /// The largest rate that bus and chips allow, rounds per second, Hz.
    pub(crate) fn most_hz(&self) -> f32 {
        Budget::new(&self.settings.sensor, self.settings.bus_hz).rate_hz()
    }

    /// Sets the rate, from the next round on.
    pub(crate) const fn set_rate(&mut self, rate: Rate) {
        self.settings.period_us = match rate {
            Rate::Max | Rate::Hz(0) => 0,
            Rate::Hz(hz) => 1_000_000 / hz as u32,
        };
        self.pace = Pace::new(self.settings.period_us);
    }

    /// Sets the scale, counts per Pa, from the next round on.
    pub(crate) const fn set_scale(&mut self, counts_per_pa: u16) {
        self.settings.transfer = Some(Transfer::per_pa(counts_per_pa));
    }

    /// Starts all chips anew before the next round, and tries isolated channels.
    pub async fn restart(&mut self) {
        self.sensor.readmit();
        self.failed = match self.sensor.start().await {
            Ok(()) => None,
            Err(error) => Some(Trouble::from(&error)),
        };
        self.back_off.succeed();
        self.not_before_us = 0;
    }

    /// Waits until the next round is due, and reads it. If rounds follow each other without a
    /// pause, it also triggers the round after it: the chips then convert while the report is sent.
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

    /// Frees the bus, if that may help. If a pin fails, the bus stays as it is, and the next round
    /// reports it.
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
