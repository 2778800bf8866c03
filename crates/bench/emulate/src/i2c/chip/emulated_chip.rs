//! What a chip is on the wires.

use std::fmt;

use super::analog::Analog;
use super::felt::Now;
use crate::i2c::barometer_settings::BarometerSettings;

/// One chip on the wires, byte by byte.
pub(in crate::i2c) trait EmulatedChip: fmt::Debug + Send {
    /// It has power, from now on: what was in its registers is gone.
    fn wake_up(&mut self);

    /// The first byte that is written to it: a register, or a command.
    fn point(&mut self, byte: u8, now_ns: u64);

    /// A byte after that.
    fn write(&mut self, byte: u8, now_ns: u64);

    /// A byte that it is asked for.
    fn read(&mut self) -> u8;

    /// STOP.
    fn stop(&mut self) {}

    /// Whether it acknowledges what is written after its address.
    fn acknowledges(&self) -> bool {
        true
    }

    /// Ends the conversions that have ended by now.
    fn settle(&mut self, now: &Now<'_>);

    /// How long it takes for a conversion as it is set, s.
    fn conversion_s(&self) -> f64;

    /// What it was calibrated to is lost, if it is kept where it can be read.
    fn lose_calibration(&mut self) {}
}

/// A part of a kind: what differs from one to the other, and what is set of all.
pub(in crate::i2c) struct Make<'a> {
    pub(in crate::i2c) analog: Analog,
    pub(in crate::i2c) settings: &'a BarometerSettings,
}

/// A kind of chip.
pub(in crate::i2c) struct Kind {
    pub(in crate::i2c) name: &'static str,
    /// 7-bit; the first is usual.
    pub(in crate::i2c) addresses: &'static [u8],
    pub(in crate::i2c) make: fn(Make<'_>) -> Box<dyn EmulatedChip>,
    /// Whether its noise stands in [`BarometerSettings`].
    pub(in crate::i2c) has_settings: bool,
}
