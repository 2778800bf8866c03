//! What is on the bus.

use super::barometer::Barometer;
use super::switch::Switch;
use crate::clock::seconds;
use crate::schedule::Schedule;
use crate::{CHANNELS, FaultKind};

/// Clocks after which whoever holds the data line has sent its byte.
const HELD_CLOCKS: u8 = 9;

/// The switch, the barometers, and what goes wrong with them.
#[derive(Debug)]
pub(super) struct Parts {
    pub(super) switch_address: u8,
    pub(super) switch: Switch,
    pub(super) barometers: [Option<Barometer>; CHANNELS],
    pub(super) schedule: Schedule,
    /// Who holds the data line, and for how many clocks more: each channel, and at the end the switch.
    held_clocks: [u8; CHANNELS + 1],
    /// How much later than it should have ended the last transaction did, ns.
    pub(super) late_ns: u64,
}

impl Parts {
    /// All well, and no channel open.
    pub(super) fn new(
        switch_address: u8,
        barometers: [Option<Barometer>; CHANNELS],
        schedule: Schedule,
    ) -> Self {
        Self {
            switch_address,
            switch: Switch::default(),
            barometers,
            schedule,
            held_clocks: [0; CHANNELS + 1],
            late_ns: 0,
        }
    }

    /// Whether somebody holds the data line on the controller's side of the switch.
    pub(super) fn is_held(&self) -> bool {
        self.holders().next().is_some()
            || self.schedule.active().any(
                |what| matches!(what, FaultKind::Short { channel } if self.switch.mask() >> channel & 1 == 1),
            )
    }

    /// Those who hold the data line until they get their clocks, and whom clocks reach.
    fn holders(&self) -> impl Iterator<Item = usize> + use<> {
        let reached = u16::from(self.switch.mask()) | 1 << CHANNELS;
        let held_clocks = self.held_clocks;
        (0..=CHANNELS).filter(move |part| reached >> part & 1 == 1 && held_clocks[*part] > 0)
    }

    /// A clock, outside any transaction.
    pub(super) fn clock(&mut self) {
        for part in self.holders() {
            self.held_clocks[part] -= 1;
        }
    }

    /// The switch's RESET: it closes its channels and lets go of the bus.
    pub(super) fn reset(&mut self) {
        self.switch.reset();
        self.held_clocks[CHANNELS] = 0;
    }

    /// What goes wrong before the next transaction.
    pub(super) fn misbehave(&mut self, now_ns: u64) {
        let happened = self.schedule.next_event(seconds(now_ns));
        for what in happened {
            match what {
                FaultKind::StuckBus { channel } => {
                    self.held_clocks[channel.map_or(CHANNELS, usize::from)] = HELD_CLOCKS;
                }
                FaultKind::SwitchBrownOut => self.switch.reset(),
                FaultKind::BarometerBrownOut { channel } => {
                    self.barometers[usize::from(channel)]
                        .iter_mut()
                        .for_each(Barometer::wake_up);
                }
                _ => {}
            }
        }
    }
}
