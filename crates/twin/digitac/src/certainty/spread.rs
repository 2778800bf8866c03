//! The probable size of a reading's error, from what is known before the measurement.

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, Ranges};

use crate::numerics::minimize;

/// Largest number of readings that the fit uses.
const MOST_READINGS: usize = 8_000;
/// Number of rounds over all parts.
const N_ROUNDS: usize = 4;
/// Tolerance of the logarithm of a part.
const TOLERANCE: f64 = 0.05;

/// What is known of a reading before it is measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    /// The twin's reading, kPa.
    pub(super) reading_kpa: f64,
    /// Its rate of change, kPa/s.
    pub(super) rate_kpa_per_s: f64,
    /// Largest reading of the frame, kPa.
    pub(super) largest_kpa: f64,
    /// OOD score of the contact, at most 1.
    pub(super) ood_score: f64,
}

/// Parts of a reading's spread. Their squares are added.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Spread {
    /// Constant part, kPa.
    still_kpa: f64,
    /// Relative to the reading.
    of_reading: f64,
    /// Relative to the largest reading of the frame.
    of_largest: f64,
    /// Relative to the largest reading of the frame, for each unit of the OOD score.
    of_unlike: f64,
    /// Relative to the reading's rate of change, s.
    of_rate_s: f64,
}

impl Checked for Spread {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            still_kpa,
            of_reading,
            of_largest,
            of_unlike,
            of_rate_s,
        } = *self;
        for (field, part) in [
            ("still_kpa", still_kpa),
            ("of_reading", of_reading),
            ("of_largest", of_largest),
            ("of_unlike", of_unlike),
            ("of_rate_s", of_rate_s),
        ] {
            ranges.number(field, part, 0.0..=1e9);
        }
    }
}

impl Spread {
    /// Fits the parts to errors, kPa, by maximum likelihood for errors with a Laplace distribution.
    pub(super) fn fit(errors: &[(Known, f64)]) -> Self {
        let thin = errors.len().div_ceil(MOST_READINGS).max(1);
        let errors: Vec<(Known, f64)> = errors.iter().copied().step_by(thin).collect();
        let size_kpa =
            errors.iter().map(|(_, error)| error.abs()).sum::<f64>() / (errors.len() as f64).max(1.0);
        let size_kpa = size_kpa.max(f64::MIN_POSITIVE);
        let mut parts = [size_kpa, 0.01, 0.01, 0.01, 0.01];
        let bounds = [
            [1e-3 * size_kpa, 10.0 * size_kpa],
            [1e-5, 1.0],
            [1e-5, 1.0],
            [1e-5, 1.0],
            [1e-5, 1.0],
        ];
        for _ in 0..N_ROUNDS {
            for part in 0..parts.len() {
                let [low, high] = bounds[part].map(f64::ln);
                let (best, _) = minimize(low, high, TOLERANCE, |ln| {
                    let mut tried = parts;
                    tried[part] = ln.exp();
                    let spread = Self::of(tried);
                    let cost = |(known, error): &(Known, f64)| {
                        let kpa = spread.kpa(known);
                        kpa.ln() + error.abs() / kpa
                    };
                    errors.iter().map(cost).sum()
                });
                parts[part] = best.exp();
            }
        }
        Self::of(parts)
    }

    fn of([still_kpa, of_reading, of_largest, of_unlike, of_rate_s]: [f64; 5]) -> Self {
        Self {
            still_kpa,
            of_reading,
            of_largest,
            of_unlike,
            of_rate_s,
        }
    }

    /// The spread of a reading, kPa.
    pub(super) fn kpa(&self, known: &Known) -> f64 {
        let parts = [
            self.still_kpa,
            self.of_reading * known.reading_kpa,
            self.of_largest * known.largest_kpa,
            self.of_unlike * known.ood_score * known.largest_kpa,
            self.of_rate_s * known.rate_kpa_per_s,
        ];
        parts.iter().map(|part| part * part).sum::<f64>().sqrt()
    }
}
