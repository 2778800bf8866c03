//! From the counts of a barometer to a pressure.

use core::fmt;

use crate::fault::Fault;

/// The 24 bits of a pressure register, unchanged.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Counts(u32);

impl Counts {
    /// From the register's three bytes, most significant byte first.
    #[must_use]
    pub const fn from_be_bytes([high, middle, low]: [u8; 3]) -> Self {
        Self(u32::from_be_bytes([0, high, middle, low]))
    }

    /// As an unsigned number, 0 to 2²⁴ - 1.
    #[must_use]
    pub const fn unsigned(self) -> u32 {
        self.0
    }

    /// As two's complement, -2²³ to 2²³ - 1.
    #[must_use]
    pub const fn signed(self) -> i32 {
        (self.0 << 8).cast_signed() >> 8
    }
}

impl fmt::Debug for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Counts({:#08x})", self.0)
    }
}

/// The result of one conversion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The raw bits of the pressure.
    pub counts: Counts,
    /// The pressure that follows from the chip's own calibration, if it has one.
    pub pressure: Pressure,
    /// The chip's temperature, °C.
    pub temperature_c: f32,
}

/// The pressure that a chip reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pressure {
    /// Pa.
    Pascal(f32),
    /// The pressure is outside the chip's range.
    OutOfRange,
    /// The chip only counts: a [`Transfer`] gives the scale.
    Unscaled,
}

impl Sample {
    /// A sample of a chip whose scale is known.
    pub(crate) fn scaled(counts: Counts, pressure_pa: f32, temperature_c: f32, range_pa: [f32; 2]) -> Self {
        let [lowest_pa, highest_pa] = range_pa;
        Self {
            counts,
            pressure: match (lowest_pa..=highest_pa).contains(&pressure_pa) {
                true => Pressure::Pascal(pressure_pa),
                false => Pressure::OutOfRange,
            },
            temperature_c,
        }
    }

    /// Pressure, Pa. `transfer` is used only for chips whose scale is unknown.
    ///
    /// # Errors
    /// [`Fault::Saturated`]: the pressure is at an end of the range or beyond.
    pub fn pressure_pa(&self, transfer: &Transfer) -> Result<f32, Fault> {
        match self.pressure {
            Pressure::Pascal(pressure_pa) => Ok(pressure_pa),
            Pressure::OutOfRange => Err(Fault::Saturated),
            Pressure::Unscaled => transfer.pressure_pa(self.counts),
        }
    }
}

/// The scale of pressure counts: `pressure = pa_per_count · counts + offset_pa`.
///
/// Parts that look alike on the bus can differ in scale; [`scale_hint`](crate::scale_hint) finds it
/// in free air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transfer {
    /// Pascal per count.
    pub pa_per_count: f32,
    /// Pressure at 0 counts, Pa.
    pub offset_pa: f32,
    /// Whether counts are two's complement, as in the family's data sheet, or run from 0 to 2²⁴
    /// - 1.
    pub signed: bool,
}

impl Transfer {
    /// The family's signed transfer without offset: the pressure is `counts / counts_per_pa`, Pa.
    #[must_use]
    pub const fn per_pa(counts_per_pa: u16) -> Self {
        Self {
            pa_per_count: 1.0 / counts_per_pa as f32,
            offset_pa: 0.0,
            signed: true,
        }
    }

    /// Pressure, Pa. Exact to 24 bits if `pa_per_count` is a power of two and the offset is 0.
    ///
    /// # Errors
    /// [`Fault::Saturated`] for the first and the last count of the range: the pressure is there or
    /// beyond.
    pub fn pressure_pa(&self, counts: Counts) -> Result<f32, Fault> {
        if self.is_saturated(counts) {
            return Err(Fault::Saturated);
        }
        let counts = if self.signed {
            counts.signed() as f32
        } else {
            counts.unsigned() as f32
        };
        Ok(counts * self.pa_per_count + self.offset_pa)
    }

    const fn is_saturated(&self, counts: Counts) -> bool {
        match self.signed {
            true => matches!(counts.0, 0x7F_FFFF | 0x80_0000),
            false => matches!(counts.0, 0x00_0000 | 0xFF_FFFF),
        }
    }

    /// The largest pressure that counts can represent, Pa.
    #[must_use]
    pub const fn full_scale_pa(&self) -> f32 {
        let most = if self.signed { 0x7F_FFFF } else { 0xFF_FFFF };
        most as f32 * self.pa_per_count + self.offset_pa
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn counts(number: i32) -> Counts {
        let [_, high, middle, low] = number.to_be_bytes();
        Counts::from_be_bytes([high, middle, low])
    }

    #[test]
    fn an_atmosphere_in_every_scale_of_the_family() {
        for (per_pa, number) in [
            (4, 405_300),
            (8, 810_600),
            (16, 1_621_200),
            (32, 3_242_400),
            (64, 6_484_800),
        ] {
            assert_eq!(
                Transfer::per_pa(per_pa).pressure_pa(counts(number)),
                Ok(101_325.0)
            );
        }
    }

    #[test]
    fn a_span_transfer_is_as_good() {
        // Consensic CPS610DSD003: P/kPa = 7.5 raw/2²³ - 3.75
        let transfer = Transfer {
            pa_per_count: 7500.0 / 8_388_608.0,
            offset_pa: -3750.0,
            signed: false,
        };
        assert_eq!(transfer.pressure_pa(counts(4_194_304)), Ok(0.0));
    }

    #[test]
    fn the_ends_of_the_range_are_flagged_and_nothing_wraps() {
        let signed = Transfer::per_pa(32);
        assert_eq!(signed.pressure_pa(counts(0x7F_FFFF)), Err(Fault::Saturated));
        assert_eq!(signed.pressure_pa(counts(-0x80_0000)), Err(Fault::Saturated));
        assert_eq!(signed.pressure_pa(counts(-32)), Ok(-1.0));
        assert_eq!(signed.pressure_pa(counts(0)), Ok(0.0));
        let unsigned = Transfer {
            signed: false,
            ..Transfer::per_pa(8)
        };
        assert_eq!(unsigned.pressure_pa(counts(0)), Err(Fault::Saturated));
        assert_eq!(unsigned.pressure_pa(counts(0xFF_FFFF)), Err(Fault::Saturated));
        assert_eq!(unsigned.pressure_pa(counts(0x80_0000)), Ok(1_048_576.0));
        assert_eq!(unsigned.full_scale_pa(), 2_097_151.9);
    }

    proptest! {
        #[test]
        fn sign_extension_undoes_truncation(number in -0x80_0000_i32..0x80_0000) {
            prop_assert_eq!(counts(number).signed(), number);
            prop_assert_eq!(counts(number).unsigned(), number.rem_euclid(0x100_0000).cast_unsigned());
        }

        #[test]
        fn powers_of_two_lose_nothing(number in -0x7F_FFFF_i32..0x7F_FFFF, exponent in 2_u32..14) {
            let per_pa = 1_u16 << exponent;
            let pressure_pa = Transfer::per_pa(per_pa).pressure_pa(counts(number)).unwrap();
            prop_assert_eq!(f64::from(pressure_pa) * f64::from(per_pa), f64::from(number));
        }

        #[test]
        fn pressure_grows_with_counts(
            one in -0x7F_FFFF_i32..0x7F_FFFF,
            other in -0x7F_FFFF_i32..0x7F_FFFF,
            pa_per_count in 1e-4_f32..1.0,
            offset_pa in -1e5_f32..1e5,
        ) {
            let transfer = Transfer { pa_per_count, offset_pa, signed: true };
            let (low, high) = (one.min(other), one.max(other));
            prop_assert!(transfer.pressure_pa(counts(low)).unwrap() <= transfer.pressure_pa(counts(high)).unwrap());
        }
    }
}
