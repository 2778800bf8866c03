//! The behaviour of a chip on the bus.

use std::fmt;

use super::analog::Analog;
use super::felt::Now;
use crate::i2c::barometer_settings::BarometerSettings;

/// One chip on the bus, byte by byte.
pub(in crate::i2c) trait EmulatedChip: fmt::Debug + Send {
    /// Power comes on now: the content of its registers is lost.
    fn wake_up(&mut self);

    /// The first byte that is written after its address: a register or a command.
    fn point(&mut self, byte: u8, now_ns: u64);

    /// A further byte that is written.
    fn write(&mut self, byte: u8, now_ns: u64);

    /// A byte that is read.
    fn read(&mut self) -> u8;

    /// STOP.
    fn stop(&mut self) {}

    /// Whether it acknowledges what is written after its address.
    fn acknowledges(&self) -> bool {
        true
    }

    /// Ends the conversions whose time is over.
    fn settle(&mut self, now: &Now<'_>);

    /// Time of a conversion with the present settings, s.
    fn conversion_s(&self) -> f64;

    /// Loses its calibration, if the calibration is kept where it can be read.
    fn lose_calibration(&mut self) {}
}

/// What a new part is made from: what differs between parts, and the settings of all parts.
pub(in crate::i2c) struct Make<'a> {
    pub(in crate::i2c) analog: Analog,
    pub(in crate::i2c) settings: &'a BarometerSettings,
}

/// A kind of chip.
pub(in crate::i2c) struct Kind {
    pub(in crate::i2c) name: &'static str,
    /// 7-bit addresses. The first one is usual.
    pub(in crate::i2c) addresses: &'static [u8],
    pub(in crate::i2c) make: fn(Make<'_>) -> Box<dyn EmulatedChip>,
    /// Whether its noise is set in [`BarometerSettings`].
    pub(in crate::i2c) has_settings: bool,
}
