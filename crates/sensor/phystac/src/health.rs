//! What only many frames tell: values that no longer change, and taxels that drift away from the others.

use crate::conversion::{Sample, Transfer};
use crate::fault::Fault;
use crate::frame::Frame;

/// From when on a taxel is suspect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// Equal samples in a row that make a taxel frozen.
    ///
    /// Default 10. A barometer's last bit is below its noise: a living part repeats itself by chance, but not ten times in pressure and
    /// temperature alike.
    pub frozen_frames: u16,
    /// Drift that is too much, Pa. Default 500: a start, not measured on a sensor.
    pub drift_pa: f32,
    /// The range that the parts are rated for, Pa: they may well count beyond it, but nobody says what. Default: all that counts can say.
    pub rated_pa: [f32; 2],
}

impl Default for Thresholds {
    fn default() -> Self {
        Self {
            frozen_frames: 10,
            drift_pa: 500.0,
            rated_pa: [f32::NEG_INFINITY, f32::INFINITY],
        }
    }
}

impl Thresholds {
    /// Whether a sample is at an end of its part's range, or of the rated one, or beyond.
    fn is_out_of_range(&self, sample: &Sample, transfer: &Transfer) -> bool {
        let [lowest_pa, highest_pa] = self.rated_pa;
        sample.pressure_pa(transfer).map_or(true, |pressure_pa| {
            !(lowest_pa..=highest_pa).contains(&pressure_pa)
        })
    }
}

/// How far a taxel at rest has gone from where it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// The taxel's change since the first frame at rest, less the median of all, Pa.
    pub drift_pa: f32,
    /// Whether that is more than [`Thresholds::drift_pa`], to either side.
    pub is_too_much: bool,
}

/// Watches the taxels from frame to frame.
#[derive(Clone, Debug)]
pub struct Health<const N: usize> {
    transfer: Transfer,
    thresholds: Thresholds,
    last: [Option<Sample>; N],
    repeats: [u16; N],
    rest_pa: [Option<f32>; N],
}

impl<const N: usize> Health<N> {
    /// Of a sensor of which no frame has been seen.
    #[must_use]
    pub const fn new(transfer: Transfer, thresholds: Thresholds) -> Self {
        Self {
            transfer,
            thresholds,
            last: [None; N],
            repeats: [0; N],
            rest_pa: [None; N],
        }
    }

    /// Looks at the next frame: what is out of range becomes [`Fault::Saturated`], what no longer changes [`Fault::Frozen`].
    ///
    /// Taxels that gave nothing stay as they are, and neither start nor end a row of equal samples.
    pub fn screen(&mut self, frame: &mut Frame<N>) {
        for ((taxel, last), repeats) in frame.taxels.iter_mut().zip(&mut self.last).zip(&mut self.repeats) {
            let Ok(sample) = *taxel else { continue };
            *repeats = if *last == Some(sample) {
                repeats.saturating_add(1)
            } else {
                1
            };
            *last = Some(sample);
            if self.thresholds.is_out_of_range(&sample, &self.transfer) {
                *taxel = Err(Fault::Saturated);
            } else if *repeats >= self.thresholds.frozen_frames {
                *taxel = Err(Fault::Frozen);
            }
        }
    }

    /// Looks at a frame taken while nothing touches the sensor: how far each taxel has drifted since the first such frame.
    ///
    /// With three or more taxels the median change is taken off, as weather, altitude and temperature change all of them. A taxel
    /// without a value in the first frame counts from the first one that has it, and its drift from there on.
    pub fn at_rest(&mut self, frame: &Frame<N>) -> [Option<Drift>; N] {
        let pressures_pa = frame.pressures_pa(&self.transfer).map(Result::ok);
        let mut changes_pa = [None; N];
        for ((change_pa, pressure_pa), rest_pa) in changes_pa.iter_mut().zip(pressures_pa).zip(self.rest_pa) {
            *change_pa = pressure_pa.zip(rest_pa).map(|(now, then)| now - then);
        }
        let common_pa = median(changes_pa).unwrap_or(0.0);
        let mut drifts = [None; N];
        for ((drift, pressure_pa), rest_pa) in drifts.iter_mut().zip(pressures_pa).zip(&mut self.rest_pa) {
            let Some(pressure_pa) = pressure_pa else { continue };
            let drift_pa = pressure_pa - common_pa - *rest_pa.get_or_insert(pressure_pa - common_pa);
            *drift = Some(Drift {
                drift_pa,
                is_too_much: drift_pa.abs() > self.thresholds.drift_pa,
            });
        }
        drifts
    }

    /// Lets the next frame at rest be the first: after the sensor was zeroed, or its gel changed.
    pub const fn forget_rest(&mut self) {
        self.rest_pa = [None; N];
    }
}

/// The middle of at least three numbers.
fn median<const N: usize>(numbers: [Option<f32>; N]) -> Option<f32> {
    let mut sorted = [f32::INFINITY; N];
    let mut n = 0;
    for (slot, number) in sorted.iter_mut().zip(numbers.into_iter().flatten()) {
        *slot = number;
        n += 1;
    }
    sorted.sort_unstable_by(f32::total_cmp);
    (n >= 3).then(|| 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conversion::{Counts, Pressure};

    fn frame<const N: usize>(pressures_pa: [Option<f32>; N]) -> Frame<N> {
        Frame {
            triggered_us: 0,
            read_us: [0; N],
            taxels: pressures_pa.map(|pressure_pa| {
                let [_, high, middle, low] =
                    ((pressure_pa.ok_or(Fault::Missing)? * 32.0) as i32).to_be_bytes();
                let counts = Counts::from_be_bytes([high, middle, low]);
                Ok(Sample {
                    counts,
                    pressure: Pressure::Unscaled,
                    temperature_c: 20.0,
                })
            }),
        }
    }

    fn health<const N: usize>() -> Health<N> {
        Health::new(Transfer::per_pa(32), Thresholds::default())
    }

    #[test]
    fn a_value_is_frozen_after_ten_frames_and_thaws_with_the_next_other_one() {
        let mut health = health();
        for repeat in 1..=15_u8 {
            let mut next = frame([Some(100_000.0), Some(100_000.0 + f32::from(repeat)), None]);
            health.screen(&mut next);
            assert_eq!(
                next.taxels[0].err(),
                (repeat >= 10).then_some(Fault::Frozen),
                "{repeat}"
            );
            assert!(next.taxels[1].is_ok());
            assert_eq!(next.taxels[2], Err(Fault::Missing));
        }
        let mut next = frame([None, None, None]);
        health.screen(&mut next);
        next = frame([Some(100_000.0), None, None]);
        health.screen(&mut next);
        assert_eq!(next.taxels[0], Err(Fault::Frozen));
        next = frame([Some(100_001.0), None, None]);
        health.screen(&mut next);
        assert!(next.taxels[0].is_ok());
    }

    #[test]
    fn what_is_out_of_range_is_saturated_however_long() {
        let mut health = health();
        for _ in 0..20 {
            let mut next = frame([Some(262_143.97)]);
            health.screen(&mut next);
            assert_eq!(next.taxels, [Err(Fault::Saturated)]);
        }
    }

    #[test]
    fn what_the_parts_are_not_rated_for_is_saturated_though_it_counts() {
        let rated = Thresholds {
            rated_pa: [50_000.0, 150_000.0],
            ..Thresholds::default()
        };
        let mut health = Health::new(Transfer::per_pa(32), rated);
        let mut next = frame([49_999.0, 50_000.0, 150_000.0, 150_001.0].map(Some));
        health.screen(&mut next);
        let [below, lowest, highest, above] = next.taxels;
        assert!(lowest.is_ok() && highest.is_ok());
        assert_eq!([below, above], [Err(Fault::Saturated); 2]);
    }

    #[test]
    fn weather_is_no_drift() {
        let mut health = health();
        let first = health.at_rest(&frame([Some(100_000.0), Some(100_100.0), Some(99_900.0), None]));
        let still = Drift {
            drift_pa: 0.0,
            is_too_much: false,
        };
        assert_eq!(first, [Some(still), Some(still), Some(still), None]);
        let later = health.at_rest(&frame([
            Some(97_000.0),
            Some(97_100.0),
            Some(97_900.0),
            Some(98_000.0),
        ]));
        let drifted = Drift {
            drift_pa: 1000.0,
            is_too_much: true,
        };
        assert_eq!(later, [Some(still), Some(still), Some(drifted), Some(still)]);
    }

    #[test]
    fn two_taxels_have_no_median() {
        let mut health = health();
        health.at_rest(&frame([Some(100_000.0), Some(100_000.0)]));
        let later = health.at_rest(&frame([Some(100_000.0), Some(100_501.0)]));
        assert_eq!(
            later[0],
            Some(Drift {
                drift_pa: 0.0,
                is_too_much: false
            })
        );
        assert_eq!(
            later[1],
            Some(Drift {
                drift_pa: 501.0,
                is_too_much: true
            })
        );
        health.forget_rest();
        assert!(
            health
                .at_rest(&frame([Some(1.0), Some(2.0)]))
                .iter()
                .flatten()
                .all(|drift| drift.drift_pa == 0.0)
        );
    }
}
