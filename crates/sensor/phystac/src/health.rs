//! Faults that only many frames show: values that no longer change, and taxels that drift away from
//! the others.

use crate::conversion::{Sample, Transfer};
use crate::fault::Fault;
use crate::frame::Frame;

/// Thresholds from which on a taxel has a fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// Number of equal samples in a row that make a taxel frozen.
    ///
    /// Default 10. The last bit of a barometer is below its noise: a working part can repeat a
    /// sample by chance, but not ten times in both pressure and temperature.
    pub frozen_frames: u16,
    /// The largest drift that is accepted, Pa. Default 500: a first choice, not measured on a
    /// sensor.
    pub drift_pa: f32,
    /// The rated range of the parts, Pa. A part may give counts beyond it, but nothing is specified
    /// for them. Default: the whole range of counts.
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
    /// Whether a sample is at an end of its part's range or beyond, or outside the rated range.
    fn is_out_of_range(&self, sample: &Sample, transfer: &Transfer) -> bool {
        let [lowest_pa, highest_pa] = self.rated_pa;
        sample.pressure_pa(transfer).map_or(true, |pressure_pa| {
            !(lowest_pa..=highest_pa).contains(&pressure_pa)
        })
    }
}

/// Drift of a taxel at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// Change of the taxel's pressure since the first frame at rest, minus the median change of all
    /// taxels, Pa.
    pub drift_pa: f32,
    /// Whether its absolute value exceeds [`Thresholds::drift_pa`].
    pub is_too_much: bool,
}

/// Monitors the taxels from frame to frame.
#[derive(Clone, Debug)]
pub struct Health<const N: usize> {
    transfer: Transfer,
    thresholds: Thresholds,
    last: [Option<Sample>; N],
    repeats: [u16; N],
    rest_pa: [Option<f32>; N],
}

impl<const N: usize> Health<N> {
    /// A monitor that has seen no frame.
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

    /// Checks the next frame: a value out of range becomes [`Fault::Saturated`], a value that no
    /// longer changes [`Fault::Frozen`].
    ///
    /// Taxels without a sample keep their fault. They neither start nor end a row of equal samples.
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

    /// Checks a frame in which nothing touches the sensor: the drift of each taxel since the first
    /// such frame.
    ///
    /// With three or more taxels the median change is subtracted, because weather, altitude and
    /// temperature change all of them. A taxel without a value in the first frame starts with the
    /// first frame in which it has one; its drift counts from there.
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

    /// Takes the next frame at rest as the first one. Call it after the sensor was zeroed, or its
    /// gel changed.
    pub const fn forget_rest(&mut self) {
        self.rest_pa = [None; N];
    }
}

/// The median of the numbers that are there. `None` if there are fewer than three.
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
