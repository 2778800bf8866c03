//! Finds the scale of a part from the atmospheric pressure.

use core::fmt;

use crate::conversion::{Counts, Pressure, Transfer};
use crate::frame::Frame;

/// Counts per Pa that a part of the family can have, if its range includes the atmosphere: 2²³
/// counts are 2.1 MPa to 131 kPa.
///
/// 8 to 64 are in the data sheet of the XGZP6847D; 4, for more than 1 MPa, continues its table.
pub const SCALES_PER_PA: [u16; 5] = [4, 8, 16, 32, 64];

/// The range of pressures that free air can have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeAir {
    /// The lowest, Pa.
    pub lowest_pa: f32,
    /// The highest, Pa. If it is less than twice the lowest, the scales can be told apart.
    pub highest_pa: f32,
}

impl FreeAir {
    /// The standard atmosphere (ISO 2533) at an altitude, ±7 % for weather and for parts that read
    /// slightly wrong. Valid for -500 to 9000 m.
    #[must_use]
    pub fn at_altitude_m(altitude_m: f32) -> Self {
        // (1 - 0.0065 K/m · altitude / 288.15 K)^5.25588 by its binomial series, because `core` has
        // no power function.
        let base = -altitude_m * (0.0065 / 288.15);
        let (mut sum, mut term) = (1.0, 1.0);
        for order in 0_u8..12 {
            let order = f32::from(order);
            term *= base * (5.25588 - order) / (order + 1.0);
            sum += term;
        }
        let standard_pa = 101_325.0 * sum;
        Self {
            lowest_pa: 0.93 * standard_pa,
            highest_pa: 1.07 * standard_pa,
        }
    }

    fn contains(&self, pressure_pa: f32) -> bool {
        (self.lowest_pa..=self.highest_pa).contains(&pressure_pa)
    }
}

/// Altitudes up to 2000 m in any weather: 80 to 108 kPa.
impl Default for FreeAir {
    fn default() -> Self {
        Self {
            lowest_pa: 80_000.0,
            highest_pa: 108_000.0,
        }
    }
}

/// The scale at which all taxels read the pressure of free air. It is a hint until somebody
/// confirms it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use = "a scale hint must be confirmed before it becomes a transfer"]
pub struct ScaleHint {
    /// Counts per Pa.
    pub counts_per_pa: u16,
    /// The lowest pressure that a taxel reads at this scale, Pa.
    pub lowest_pa: f32,
    /// The highest, Pa.
    pub highest_pa: f32,
}

impl ScaleHint {
    /// The transfer, confirmed by somebody who knows the part.
    ///
    /// The atmosphere does not tell whether counts are `signed`. The range does: if the part's
    /// range exceeds the [`full_scale_pa`](Transfer::full_scale_pa) of the signed transfer, the
    /// counts are not signed.
    #[must_use]
    pub const fn confirm(self, signed: bool) -> Transfer {
        Transfer {
            signed,
            ..Transfer::per_pa(self.counts_per_pa)
        }
    }
}

/// The scale at which all taxels of a frame read the pressure of free air. Nothing may touch the
/// sensor in this frame.
///
/// Taxels without a sample, and taxels whose chip has a known scale, are ignored.
///
/// # Errors
/// There is not exactly one such scale.
pub fn scale_hint<const N: usize>(frame: &Frame<N>, air: FreeAir) -> Result<ScaleHint, ScaleError> {
    let mut hint = None;
    for (taxel, sample) in frame.taxels.iter().enumerate() {
        let Ok(sample) = sample else { continue };
        if sample.pressure != Pressure::Unscaled {
            continue;
        }
        let counts_per_pa = scale_of(taxel, sample.counts, air)?;
        let pressure_pa = pressure_pa(sample.counts, counts_per_pa);
        let so_far = *hint.get_or_insert(ScaleHint {
            counts_per_pa,
            lowest_pa: pressure_pa,
            highest_pa: pressure_pa,
        });
        if so_far.counts_per_pa != counts_per_pa {
            let scales_per_pa = [so_far.counts_per_pa, counts_per_pa];
            return Err(ScaleError::Disagreement { taxel, scales_per_pa });
        }
        hint = Some(ScaleHint {
            counts_per_pa,
            lowest_pa: so_far.lowest_pa.min(pressure_pa),
            highest_pa: so_far.highest_pa.max(pressure_pa),
        });
    }
    hint.ok_or(ScaleError::NoSample)
}

/// The only scale, in counts per Pa, at which a taxel reads the pressure of free air.
fn scale_of(taxel: usize, counts: Counts, air: FreeAir) -> Result<u16, ScaleError> {
    let mut fitting = SCALES_PER_PA
        .into_iter()
        .filter(|per_pa| air.contains(pressure_pa(counts, *per_pa)));
    let first = fitting.next().ok_or(ScaleError::NoScale { taxel, counts })?;
    match fitting.next() {
        None => Ok(first),
        Some(second) => Err(ScaleError::Ambiguous {
            taxel,
            counts,
            scales_per_pa: [first, second],
        }),
    }
}

fn pressure_pa(counts: Counts, counts_per_pa: u16) -> f32 {
    counts.signed() as f32 / f32::from(counts_per_pa)
}

/// Why there is no scale hint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScaleError {
    /// No taxel gave a value.
    NoSample,
    /// At no scale of the family does a taxel read the pressure of free air: it is another part,
    /// has another transfer, or is pressed.
    NoScale {
        /// The taxel.
        taxel: usize,
        /// What it reads.
        counts: Counts,
    },
    /// More than one scale fits: narrow down [`FreeAir`].
    Ambiguous {
        /// The taxel.
        taxel: usize,
        /// What it reads.
        counts: Counts,
        /// Two scales that fit, counts per Pa.
        scales_per_pa: [u16; 2],
    },
    /// Different scales fit different taxels: parts of different range, or a broken one.
    Disagreement {
        /// The first taxel that differs from those before it.
        taxel: usize,
        /// The scale of those before, then its own, counts per Pa.
        scales_per_pa: [u16; 2],
    },
}

impl fmt::Display for ScaleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSample => f.write_str("no taxel gave a value"),
            Self::NoScale { taxel, counts } => {
                write!(
                    f,
                    "taxel {taxel} reads {} counts, which no known scale makes free air",
                    counts.signed()
                )
            }
            Self::Ambiguous {
                taxel,
                counts,
                scales_per_pa: [one, other],
            } => {
                let counts = counts.signed();
                write!(
                    f,
                    "taxel {taxel} reads {counts} counts, which is free air at {one} and at {other} counts per Pa"
                )
            }
            Self::Disagreement {
                taxel,
                scales_per_pa: [others, own],
            } => {
                write!(
                    f,
                    "taxel {taxel} reads free air at {own} counts per Pa, those before it at {others}"
                )
            }
        }
    }
}

impl core::error::Error for ScaleError {}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::conversion::Sample;
    use crate::fault::Fault;

    fn frame<const N: usize>(numbers: [Option<i32>; N]) -> Frame<N> {
        Frame {
            triggered_us: 0,
            read_us: [0; N],
            taxels: numbers.map(|number| {
                let [_, high, middle, low] = number.ok_or(Fault::Missing)?.to_be_bytes();
                let counts = Counts::from_be_bytes([high, middle, low]);
                Ok(Sample {
                    counts,
                    pressure: Pressure::Unscaled,
                    temperature_c: 20.0,
                })
            }),
        }
    }

    #[test]
    fn an_atmosphere_is_told_from_its_counts() {
        let counts = [
            (405_300, 4),
            (810_600, 8),
            (1_621_200, 16),
            (3_242_400, 32),
            (6_484_800, 64),
        ];
        for (number, counts_per_pa) in counts {
            let hint = scale_hint(&frame([Some(number), None]), FreeAir::default());
            let expected = ScaleHint {
                counts_per_pa,
                lowest_pa: 101_325.0,
                highest_pa: 101_325.0,
            };
            assert_eq!(hint, Ok(expected));
        }
    }

    #[test]
    fn what_is_not_clear_is_not_guessed() {
        let air = FreeAir::default();
        assert_eq!(scale_hint(&frame([None, None]), air), Err(ScaleError::NoSample));
        for number in [0, -3_242_400, 0x7F_FFFF, -0x80_0000, 2_300_000] {
            let counts = frame([Some(number)]).taxels[0].unwrap().counts;
            assert_eq!(
                scale_hint(&frame([None, Some(number)]), air),
                Err(ScaleError::NoScale { taxel: 1, counts })
            );
        }
        let mixed = scale_hint(&frame([Some(3_242_400), Some(3_242_401), Some(405_300)]), air);
        assert_eq!(
            mixed,
            Err(ScaleError::Disagreement {
                taxel: 2,
                scales_per_pa: [32, 4]
            })
        );
        let anywhere = FreeAir {
            lowest_pa: 30_000.0,
            ..air
        };
        let unclear = scale_hint(&frame([Some(3_242_400)]), anywhere);
        assert!(matches!(
            unclear,
            Err(ScaleError::Ambiguous {
                taxel: 0,
                scales_per_pa: [32, 64],
                ..
            })
        ));
    }

    #[test]
    fn altitude_follows_the_standard_atmosphere() {
        // ISO 2533
        for (altitude_m, standard_pa) in [
            (0.0, 101_325.0),
            (1000.0, 89_874.6),
            (2000.0, 79_495.2),
            (4000.0, 61_640.2),
            (8000.0, 35_599.8),
        ] {
            let air = FreeAir::at_altitude_m(altitude_m);
            let middle_pa = 0.5 * (air.lowest_pa + air.highest_pa);
            assert!(
                (middle_pa / standard_pa - 1.0).abs() < 2e-4,
                "{altitude_m} m: {middle_pa} Pa"
            );
        }
        let in_la_paz = FreeAir::at_altitude_m(3640.0);
        assert_eq!(
            scale_hint(&frame([Some(65_000 * 16)]), in_la_paz).map(|found| found.counts_per_pa),
            Ok(16)
        );
    }

    #[test]
    fn the_range_decides_whether_counts_are_signed() {
        let hint = scale_hint(&frame([Some(810_600)]), FreeAir::default()).unwrap();
        assert!(hint.confirm(true).full_scale_pa() < 1_500_000.0);
        assert!(hint.confirm(false).full_scale_pa() > 1_500_000.0);
    }

    proptest! {
        #[test]
        fn any_weather_below_2000_m_hints_at_the_true_scale(
            pressure_pa in 80_001_f32..107_999.0,
            scale in 0_usize..SCALES_PER_PA.len(),
        ) {
            let per_pa = SCALES_PER_PA[scale];
            let number = (pressure_pa * f32::from(per_pa)) as i32;
            let found = scale_hint(&frame([Some(number)]), FreeAir::default()).unwrap();
            prop_assert_eq!(found.counts_per_pa, per_pa);
        }
    }
}
