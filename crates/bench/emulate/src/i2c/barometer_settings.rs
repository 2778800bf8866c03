//! Settings of a CPS135B.

use serde::{Deserialize, Serialize};

/// A variant of the CPS135B.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BarometerSettings {
    /// Counts per Pa.
    pub counts_per_pa: f64,
    /// Pressure at 0 counts, Pa.
    pub offset_pa: f64,
    /// Whether counts are in two's complement. Otherwise they go from 0 to 2²⁴ - 1.
    pub is_signed: bool,
    /// Standard deviation of a reading of 1024 samples, Pa. It falls with the square root of the
    /// number of samples.
    pub noise_pa: f64,
    /// Time of a conversion of temperature and pressure with 1024 samples, s.
    pub conversion_s: f64,
    /// Additional time for each further 1024 samples, s. This is a guess.
    pub conversion_s_per_1024: f64,
    /// Standard deviation of the times of parts from these times, as a fraction.
    pub conversion_spread: f64,
    /// Value of register 0xA6 after power-up: the factory's gain, and in the lowest three bits the
    /// code of the samples.
    pub pressure_configuration: u8,
}

impl Default for BarometerSettings {
    /// 32 counts per Pa, 15 Pa of noise, conversions of 5.7 ms with a spread of 2 %.
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

impl BarometerSettings {
    /// The 24 bits of a pressure, clamped to their range.
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
