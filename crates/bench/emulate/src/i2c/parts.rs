//! The parts on the bus.

use super::chip::{EmulatedChip, Felt, Now};
use super::switch::Switch;
use crate::clock::seconds;
use crate::schedule::Schedule;
use crate::{FaultKind, Workcell};

/// Clocks after which a part that holds the data line has sent its byte.
const HELD_CLOCKS: u8 = 9;

/// A barometer that is soldered to the board.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) address: u8,
    /// The switch and channel that it is behind. `None`: it is on the bus itself.
    pub(super) behind: Option<(usize, u8)>,
    /// Index of its pressure in the output of the physics.
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

    /// Ends the operations whose time is over.
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

/// The switches, the barometers and their faults.
#[derive(Debug)]
pub(super) struct Parts {
    /// In the order of their addresses.
    pub(super) switches: Vec<Switch>,
    pub(super) barometers: Vec<Part>,
    pub(super) schedule: Schedule,
    /// Clocks for which each part still holds the data line: each channel, counted over all
    /// switches, and last the first switch.
    held_clocks: [u8; 65],
    /// Delay of the end of the last transaction, ns.
    pub(super) late_ns: u64,
}

/// Index of the first switch in `held_clocks`.
const SWITCH: usize = 64;

impl Parts {
    /// Parts without a fault, with all channels closed.
    pub(super) fn new(switches: Vec<Switch>, barometers: Vec<Part>, schedule: Schedule) -> Self {
        Self {
            switches,
            barometers,
            schedule,
            held_clocks: [0; 65],
            late_ns: 0,
        }
    }

    /// Whether a channel, counted over all switches, is open.
    pub(super) fn is_open(&self, channel: u8) -> bool {
        let switch = self.switches.get(usize::from(channel / 8));
        switch.is_some_and(|switch| switch.mask() >> (channel % 8) & 1 == 1)
    }

    /// Whether a part holds the data line on the controller's side of the switches.
    pub(super) fn is_held(&self) -> bool {
        let holds = |what| matches!(what, FaultKind::Short { channel } if self.is_open(channel));
        (0..self.held_clocks.len()).any(|part| self.holds(part)) || self.schedule.active().any(holds)
    }

    /// Whether a part holds the data line until it gets its clocks, and clocks reach it.
    fn holds(&self, part: usize) -> bool {
        self.held_clocks[part] > 0 && (part == SWITCH || self.is_open(part as u8))
    }

    /// One clock, outside any transaction.
    pub(super) fn clock(&mut self) {
        for part in 0..self.held_clocks.len() {
            if self.holds(part) {
                self.held_clocks[part] -= 1;
            }
        }
    }

    /// RESET of the switches: they close their channels and release the bus.
    pub(super) fn reset(&mut self) {
        self.switches.iter_mut().for_each(Switch::reset);
        self.held_clocks[SWITCH] = 0;
    }

    /// Carries out the faults that happen before the next transaction.
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
