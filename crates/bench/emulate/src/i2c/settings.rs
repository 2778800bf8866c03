//! What is soldered to the board.

use serde::{Deserialize, Serialize};

use crate::error::{check_not_negative, check_positive};
use crate::{CHANNELS, EmulateError};

/// A board of a switch and barometers, and the bus it is on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BoardSettings {
    /// Clock of the bus, Hz.
    pub bus_hz: f64,
    /// After how long the controller gives up a transaction that cannot begin, s.
    pub timeout_s: f64,
    /// The switch's 7-bit address.
    pub switch_address: u8,
    /// Channels that have a barometer.
    pub channels: Vec<u8>,
    /// What the barometers are like.
    pub barometer: BarometerSettings,
    /// Seed of noise, and of what differs between parts.
    pub seed: u64,
}

/// A kind of barometer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BarometerSettings {
    /// Counts for a pascal.
    pub counts_per_pa: f64,
    /// Pressure at 0 counts, Pa.
    pub offset_pa: f64,
    /// Whether counts are two's complement, rather than from 0 to 2²⁴ - 1.
    pub is_signed: bool,
    /// Deviation of a reading at 1024 samples, Pa; more samples are quieter by the square root.
    pub noise_pa: f64,
    /// Time of a conversion of temperature and pressure at 1024 samples, s.
    pub conversion_s: f64,
    /// Time that each further 1024 samples take, s; a guess.
    pub conversion_s_per_1024: f64,
    /// Deviation of parts' times from these, as a fraction.
    pub conversion_spread: f64,
    /// What register 0xA6 wakes up with: the factory's gain, and in the lowest three bits the code of the samples.
    pub pressure_configuration: u8,
}

impl Default for BoardSettings {
    /// Eight barometers on a bus of 400 kHz, a switch at 0x70, seed 1.
    fn default() -> Self {
        Self {
            bus_hz: 400_000.0,
            timeout_s: 1e-3,
            switch_address: 0x70,
            channels: (0..CHANNELS as u8).collect(),
            barometer: BarometerSettings::default(),
            seed: 1,
        }
    }
}

impl Default for BarometerSettings {
    /// 32 counts for a pascal, 15 Pa of noise, conversions of 5.7 ms, give or take 2 %.
    fn default() -> Self {
        Self {
            counts_per_pa: 32.0,
            offset_pa: 0.0,
            is_signed: true,
            noise_pa: 15.0,
            conversion_s: 5.7e-3,
            conversion_s_per_1024: 0.4e-3,
            conversion_spread: 0.02,
            pressure_configuration: 0x28,
        }
    }
}

impl BoardSettings {
    pub(crate) fn check(&self) -> Result<(), EmulateError> {
        check_positive(&[("board.bus_hz", self.bus_hz), ("board.timeout_s", self.timeout_s)])?;
        if !(0x70..=0x77).contains(&self.switch_address) {
            let problem = format!("is {:#04x}, expected 0x70 to 0x77", self.switch_address);
            return Err(EmulateError::setting("board.switch_address", problem));
        }
        if let Some(channel) = self.channels.iter().find(|channel| **channel >= 8) {
            let problem = format!("has {channel}, expected 0 to 7");
            return Err(EmulateError::setting("board.channels", problem));
        }
        let barometer = &self.barometer;
        check_positive(&[
            ("board.barometer.counts_per_pa", barometer.counts_per_pa),
            ("board.barometer.conversion_s", barometer.conversion_s),
        ])?;
        check_not_negative(&[
            ("board.barometer.noise_pa", barometer.noise_pa),
            (
                "board.barometer.conversion_s_per_1024",
                barometer.conversion_s_per_1024,
            ),
            ("board.barometer.conversion_spread", barometer.conversion_spread),
        ])
    }
}

impl BarometerSettings {
    /// The 24 bits of a pressure, held at the ends of their range.
    #[must_use]
    pub fn counts(&self, pressure_pa: f64) -> u32 {
        let counts = ((pressure_pa - self.offset_pa) * self.counts_per_pa).round() as i64;
        if self.is_signed {
            counts.clamp(-0x80_0000, 0x7F_FFFF) as u32 & 0xFF_FFFF // two's complement in 24 bits
        } else {
            counts.clamp(0, 0xFF_FFFF) as u32
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_hold_at_the_ends_of_their_range() {
        let signed = BarometerSettings::default();
        assert_eq!(signed.counts(101_325.0), 3_242_400);
        assert_eq!(signed.counts(-1.0), 0xFF_FFE0);
        assert_eq!(signed.counts(1e6), 0x7F_FFFF);
        assert_eq!(signed.counts(-1e6), 0x80_0000);
        let unsigned = BarometerSettings {
            is_signed: false,
            counts_per_pa: 8.0,
            offset_pa: 1000.0,
            ..signed
        };
        assert_eq!(unsigned.counts(0.0), 0);
        assert_eq!(unsigned.counts(1_049_576.0), 0x80_0000);
        assert_eq!(unsigned.counts(1e9), 0xFF_FFFF);
    }
}
