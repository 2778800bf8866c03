//! What each barometer makes of the pressure at its port, fitted directly: the start of every physical
//! variant, and the inner fit of the bench.

use serde::{Deserialize, Serialize};

use super::{Features, overstress};
use crate::numerics::{fit_nonnegative, minimize};

/// Linear readings: gain × (pressure + Σ memory × overstress), taxel by taxel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gains {
    /// Reading over port pressure of the relaxed gel; `[n_taxels]`.
    pub gain: Vec<f64>,
    /// Share of each time constant's overstress in the reading; `[n_taxels][n_time_constants]`.
    pub memory: Vec<Vec<f64>>,
    /// The time constants, s.
    pub time_constants_s: Vec<f64>,
}

/// Time constants that fits start from, s: two are enough for barometers cast into rubber, one while the load
/// moves and one in a hold.
pub(crate) const TIME_CONSTANTS_S: [f64; 2] = [0.25, 4.0];
/// How far from its start a time constant is looked for, as a factor.
const TIME_CONSTANT_REACH: f64 = 4.0;

/// A press as far as this fit sees it.
pub(crate) struct Sample<'a> {
    pub(crate) features: &'a Features,
    pub(crate) readings_kpa: &'a [Vec<f64>],
    pub(crate) valid: &'a [Vec<bool>],
}

impl Gains {
    /// Fits by least absolute deviations; no gain and no memory is negative. Returns with it the mean
    /// absolute deviation of each taxel, kPa. Static samples, of one frame, have no memory.
    pub(crate) fn fit(samples: &[Sample<'_>], time_constants_s: &[f64]) -> (Self, Vec<f64>) {
        let n_taxels = samples
            .first()
            .and_then(|s| s.features.pressure_kpa.first())
            .map_or(0, Vec::len);
        let mut gains = Self {
            gain: Vec::new(),
            memory: Vec::new(),
            time_constants_s: time_constants_s.to_vec(),
        };
        let mut deviations_kpa = Vec::with_capacity(n_taxels);
        for taxel in 0..n_taxels {
            let (columns, target) = columns(samples, taxel, time_constants_s);
            let (fit, deviation) = fit_nonnegative(&columns, &target);
            gains.gain.push(fit[0]);
            let share = |a: &f64| if fit[0] > 0.0 { a / fit[0] } else { 0.0 };
            gains.memory.push(fit[1..].iter().map(share).collect());
            deviations_kpa.push(deviation);
        }
        (gains, deviations_kpa)
    }

    /// Fits the time constants too, one after the other, each within a factor of four of where it starts.
    pub(crate) fn fit_with_time_constants(samples: &[Sample<'_>], start_s: &[f64]) -> Self {
        let deviation = |constants_s: &[f64]| Self::fit(samples, constants_s).1.iter().sum::<f64>();
        let mut constants_s = start_s.to_vec();
        for _ in 0..2 {
            for index in 0..constants_s.len() {
                let center = start_s[index].ln();
                let reach = TIME_CONSTANT_REACH.ln();
                let mut trial = constants_s.clone();
                let at = |ln_constant: f64| {
                    trial[index] = ln_constant.exp();
                    deviation(&trial)
                };
                constants_s[index] = minimize(center - reach, center + reach, 0.02, at).0.exp();
            }
        }
        Self::fit(samples, &constants_s).0
    }

    /// The reading that these gains alone give, kPa; `[n_frames][n_taxels]`.
    #[must_use]
    pub fn readings_kpa(&self, features: &Features) -> Vec<Vec<f64>> {
        let elastic = features.pressure_kpa.iter();
        let elastic: Vec<Vec<f64>> = elastic
            .map(|row| row.iter().zip(&self.gain).map(|(p, gain)| gain * p).collect())
            .collect();
        self.remember(&features.time_s, elastic)
    }

    /// Adds the overstresses to elastic readings; `[n_frames][n_taxels]`, any unit.
    pub(crate) fn remember(&self, time_s: &[f64], mut readings: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        for (taxel, shares) in self.memory.iter().enumerate() {
            let elastic: Vec<f64> = readings.iter().map(|row| row[taxel]).collect();
            for (share, constant_s) in shares.iter().zip(&self.time_constants_s) {
                for (row, q) in readings
                    .iter_mut()
                    .zip(overstress::of(time_s, &elastic, *constant_s))
                {
                    row[taxel] += share * q;
                }
            }
        }
        readings
    }
}

/// Pressure and overstresses of one taxel over all usable frames, and the readings.
fn columns(samples: &[Sample<'_>], taxel: usize, time_constants_s: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
    let mut columns = vec![Vec::new(); 1 + time_constants_s.len()];
    let mut target = Vec::new();
    for sample in samples {
        let pressure: Vec<f64> = sample
            .features
            .pressure_kpa
            .iter()
            .map(|row| row[taxel])
            .collect();
        let usable: Vec<usize> = (0..pressure.len())
            .filter(|&frame| sample.valid[frame][taxel])
            .collect();
        columns[0].extend(usable.iter().map(|&frame| pressure[frame]));
        target.extend(usable.iter().map(|&frame| sample.readings_kpa[frame][taxel]));
        for (column, time_constant_s) in columns[1..].iter_mut().zip(time_constants_s) {
            let q = overstress::of(&sample.features.time_s, &pressure, *time_constant_s);
            column.extend(usable.iter().map(|&frame| q[frame]));
        }
    }
    (columns, target)
}
