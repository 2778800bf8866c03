//! The inputs of a classifier, made from the readings of a press.

use std::fmt::{Display, Formatter};

use serde::{Deserialize, Serialize};

/// Number of samples of a series.
pub(crate) const N_SAMPLES: usize = 12;
/// Number of frames at the start whose mean is subtracted.
const N_UNTOUCHED: usize = 3;
/// A press whose readings never exceed this, kPa, was not felt.
const SMALLEST_KPA: f64 = 1e-6;

/// Contact begins where the largest reading first exceeds this fraction of the press's largest
/// reading.
const IN_CONTACT: f64 = 0.02;

/// How the samples of a press are spaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sampling {
    /// At equal steps of the largest reading, during loading. The speed of the press and the
    /// duration of its hold do not matter.
    Load,
    /// At equal steps of time, from first to last contact.
    Time,
}

impl Display for Sampling {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Load => "load",
            Self::Time => "time",
        })
    }
}

/// Readings of the taxels during a press, as samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Readings over the largest reading of the sample, or of the press if the samples are at equal
    /// steps of time; `[N_SAMPLES][n_taxels]`.
    pub(crate) shares: Vec<Vec<f32>>,
    /// The largest reading of the press, kPa.
    pub(crate) largest_kpa: f32,
}

/// A press with a known shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// Index of the shape, from zero.
    pub class: usize,
    /// Its readings.
    pub series: Series,
}

impl Series {
    /// The series of a press, from its readings with any constant offset, kPa;
    /// `[n_frames][n_taxels]`. A press starts without contact: the mean of its first three frames
    /// is taken as zero. `None` if nothing was felt.
    #[must_use]
    pub fn of(readings_kpa: &[Vec<f64>], sampling: Sampling) -> Option<Self> {
        let n_taxels = readings_kpa.first()?.len();
        let untouched = &readings_kpa[..N_UNTOUCHED.min(readings_kpa.len())];
        let zero =
            |taxel: usize| untouched.iter().map(|row| row[taxel]).sum::<f64>() / untouched.len() as f64;
        let zero_kpa: Vec<f64> = (0..n_taxels).map(zero).collect();
        let above = |frame: usize, taxel: usize| readings_kpa[frame][taxel] - zero_kpa[taxel];
        let most = |frame: usize| (0..n_taxels).map(|taxel| above(frame, taxel)).fold(0.0, f64::max);
        let most_kpa: Vec<f64> = (0..readings_kpa.len()).map(most).collect();
        let largest_kpa = most_kpa.iter().copied().fold(0.0, f64::max);
        if largest_kpa <= SMALLEST_KPA {
            return None;
        }
        let touches = |kpa: &f64| *kpa > IN_CONTACT * largest_kpa;
        let (first, last) = (
            most_kpa.iter().position(touches)?,
            most_kpa.iter().rposition(touches)?,
        );
        let sample = |index: usize| {
            let (at, over_kpa) = match sampling {
                Sampling::Load => {
                    let level_kpa = largest_kpa * ((index + 1) as f64 / N_SAMPLES as f64);
                    (reaches(&most_kpa, level_kpa)?, level_kpa)
                }
                Sampling::Time => {
                    let part = index as f64 / (N_SAMPLES - 1) as f64;
                    (first as f64 + (last - first) as f64 * part, largest_kpa)
                }
            };
            let (before, part) = (at as usize, at.fract());
            let after = (before + 1).min(readings_kpa.len() - 1);
            let read = |taxel| above(before, taxel) * (1.0 - part) + above(after, taxel) * part;
            let shares = (0..n_taxels).map(|taxel| (read(taxel) / over_kpa) as f32);
            Some(shares.collect())
        };
        Some(Self {
            shares: (0..N_SAMPLES).map(sample).collect::<Option<_>>()?,
            largest_kpa: largest_kpa as f32,
        })
    }

    pub(crate) fn n_taxels(&self) -> usize {
        self.shares[0].len()
    }
}

/// The frame, with a fraction of the next, at which a rising quantity first reaches a level.
fn reaches(values: &[f64], level: f64) -> Option<f64> {
    let after = values.iter().position(|value| *value >= level)?;
    let before = after.saturating_sub(1);
    let rise = values[after] - values[before];
    let part = if rise > 0.0 {
        (level - values[before]) / rise
    } else {
        0.0
    };
    Some(before as f64 + part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_follows_the_load_and_not_the_time() {
        let press = |frames_in: usize, frames_held: usize| {
            let mut readings_kpa = vec![vec![100.0, 50.0]; 3];
            let depths = (1..=frames_in).map(|frame| frame as f64 / frames_in as f64);
            for depth in depths.chain((0..frames_held).map(|frame| 1.0 - 0.01 * frame as f64)) {
                readings_kpa.push(vec![100.0 + 24.0 * depth, 50.0 - 6.0 * depth * depth]);
            }
            Series::of(&readings_kpa, Sampling::Load).unwrap()
        };
        let series = press(48, 0);
        assert_eq!(series.largest_kpa, 24.0);
        assert_eq!(series.shares.len(), N_SAMPLES);
        assert_eq!(series.shares[N_SAMPLES - 1], [1.0, -0.25]);
        assert_eq!(series.shares[N_SAMPLES / 2 - 1], [1.0, -0.125]);
        let slower = press(480, 200);
        for (row, other) in series.shares.iter().zip(&slower.shares) {
            assert!(row.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-3));
        }
    }

    #[test]
    fn a_series_over_time_runs_from_first_to_last_contact() {
        let mut readings_kpa = vec![vec![100.0, 50.0]; 10];
        for (frame, row) in readings_kpa.iter_mut().enumerate().take(8).skip(4) {
            row[0] += 2.0 * (frame as f64 - 3.0);
            row[1] -= 1.0;
        }
        let series = Series::of(&readings_kpa, Sampling::Time).unwrap();
        assert_eq!(series.largest_kpa, 8.0);
        assert_eq!(series.shares[0], [0.25, -0.125]);
        assert_eq!(series.shares[N_SAMPLES - 1], [1.0, -0.125]);
        let middle = &series.shares[N_SAMPLES / 2][0];
        assert!((0.5..0.8).contains(middle), "{middle}");
    }

    #[test]
    fn what_is_not_felt_is_no_series() {
        assert_eq!(Series::of(&[], Sampling::Load), None);
        assert_eq!(Series::of(&vec![vec![101.3; 8]; 20], Sampling::Load), None);
    }

    #[test]
    fn a_press_that_jumps_to_its_depth_is_a_series() {
        let readings_kpa = [[0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [8.0, 4.0]];
        let series = Series::of(&readings_kpa.map(|row| row.to_vec()), Sampling::Load).unwrap();
        for row in &series.shares {
            assert!((row[0] - 1.0).abs() < 1e-6 && (row[1] - 0.5).abs() < 1e-6);
        }
    }
}
