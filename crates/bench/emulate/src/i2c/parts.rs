//! What is on the bus.

use super::chip::{EmulatedChip, Felt, Now};
use super::switch::Switch;
use crate::clock::seconds;
use crate::schedule::Schedule;
use crate::{FaultKind, Workcell};

/// Clocks after which whoever holds the data line has sent its byte.
const HELD_CLOCKS: u8 = 9;

/// A barometer that is soldered to the board.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) address: u8,
    /// Which of the switches it is behind, and on which channel; `None`: it is on the bus itself.
    pub(super) behind: Option<(usize, u8)>,
    /// Which of the pressures that are felt is its own.
    pub(super) taxel: usize,
    pub(super) chip: Box<dyn EmulatedChip>,
    /// Whether the next byte written is the first after its address.
    pub(super) is_addressed: bool,
}

impl Part {
    /// Its channel, counted over all switches.
    pub(super) fn channel(&self) -> Option<u8> {
        self.behind.map(|(switch, channel)| 8 * switch as u8 + channel)
    }

    /// Lets what was under way until now end.
    pub(super) fn settle(&mut self, now_ns: u64, is_endless: bool, workcell: &Workcell) {
        let taxel = self.taxel;
        let felt = |ns: u64| {
            let sensed = workcell.at_ns(ns).sensed;
            Felt {
                pressure_pa: 1000.0 * sensed.taxel_pressures_kpa[taxel],
                temperature_c: sensed.temperature_c,
            }
        };
        self.chip.settle(&Now {
            ns: now_ns,
            is_endless,
            felt: &felt,
        });
    }
}

/// The switches, the barometers, and what goes wrong with them.
#[derive(Debug)]
pub(super) struct Parts {
    /// By address.
    pub(super) switches: Vec<Switch>,
    pub(super) barometers: Vec<Part>,
    pub(super) schedule: Schedule,
    /// Who holds the data line, and for how many clocks more: each channel, counted over all switches, and the first switch.
    held_clocks: [u8; 65],
    /// How much later than it should have ended the last transaction did, ns.
    pub(super) late_ns: u64,
}

/// The first switch, among those who may hold the data line.
const SWITCH: usize = 64;

impl Parts {
    /// All well, and no channel open.
    pub(super) fn new(switches: Vec<Switch>, barometers: Vec<Part>, schedule: Schedule) -> Self {
        Self {
            switches,
            barometers,
            schedule,
            held_clocks: [0; 65],
            late_ns: 0,
        }
    }

    /// Whether a channel is open, counted over all switches.
    pub(super) fn is_open(&self, channel: u8) -> bool {
        let switch = self.switches.get(usize::from(channel / 8));
        switch.is_some_and(|switch| switch.mask() >> (channel % 8) & 1 == 1)
    }

    /// Whether somebody holds the data line on the controller's side of the switches.
    pub(super) fn is_held(&self) -> bool {
        let holds = |what| matches!(what, FaultKind::Short { channel } if self.is_open(channel));
        (0..self.held_clocks.len()).any(|part| self.holds(part)) || self.schedule.active().any(holds)
    }

    /// Whether somebody holds the data line until it gets its clocks, and clocks reach it.
    fn holds(&self, part: usize) -> bool {
        self.held_clocks[part] > 0 && (part == SWITCH || self.is_open(part as u8))
    }

    /// A clock, outside any transaction.
    pub(super) fn clock(&mut self) {
        for part in 0..self.held_clocks.len() {
            if self.holds(part) {
                self.held_clocks[part] -= 1;
            }
        }
    }

    /// The switches' RESET: they close their channels and let go of the bus.
    pub(super) fn reset(&mut self) {
        self.switches.iter_mut().for_each(Switch::reset);
        self.held_clocks[SWITCH] = 0;
    }

    /// What goes wrong before the next transaction.
    pub(super) fn misbehave(&mut self, now_ns: u64) {
        let happened = self.schedule.next_event(seconds(now_ns));
        for what in happened {
            match what {
                FaultKind::StuckBus { channel } => {
                    self.held_clocks[channel.map_or(SWITCH, usize::from)] = HELD_CLOCKS;
                }
                FaultKind::SwitchBrownOut => self.switches.iter_mut().for_each(Switch::reset),
                FaultKind::BarometerBrownOut { channel } => self.on_channel(channel, |chip| chip.wake_up()),
                FaultKind::LostCalibration { channel } => {
                    self.on_channel(channel, |chip| chip.lose_calibration())
                }
                _ => {}
            }
        }
    }

    fn on_channel(&mut self, channel: u8, mut happens: impl FnMut(&mut dyn EmulatedChip)) {
        let here = self
            .barometers
            .iter_mut()
            .filter(|part| part.channel() == Some(channel));
        here.for_each(|part| happens(part.chip.as_mut()));
    }
}
