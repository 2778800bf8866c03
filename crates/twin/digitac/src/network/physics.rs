//! The fixed part of a variant, which is not learned.

use super::{Normalization, Variant};
use crate::Features;
use crate::features::Gains;
use twintac_learn::Matrix;

/// Overstress shares below this start at it, because the gradient vanishes at zero.
const SMALLEST_MEMORY: f64 = 1e-3;

/// The fixed part of a variant, which is not learned.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Physics {
    pub(crate) variant: Variant,
    pub(crate) gains: Gains,
    pub(crate) normalization: Normalization,
    /// Largest correction as a fraction of the size of the frame's readings.
    pub(crate) correction_limit: f64,
}

impl Physics {
    /// The variant's input from a press: port pressures, kPa, or the paper's stress features,
    /// kPa/mm; `[n_frames][n_taxels]`.
    pub(crate) fn seen<'a>(&self, features: &'a Features) -> &'a [Vec<f64>] {
        match self.variant {
            Variant::Paper => &features.stress_kpa_per_mm,
            _ => &features.pressure_kpa,
        }
    }

    /// Inputs of the variant, of order one; `[n_frames][n_taxels]`.
    pub(crate) fn inputs(&self, features: &Features) -> Matrix {
        let seen = self.seen(features);
        let mut inputs = Matrix::zeros(seen.len(), self.n_taxels());
        for (row, seen) in inputs.rows_mut().zip(seen) {
            self.scale(seen, row);
        }
        inputs
    }

    /// Inputs of order one from the variant's input of one frame; `[n_taxels]`.
    pub(crate) fn scale(&self, seen: &[f64], inputs: &mut [f32]) {
        let n = &self.normalization;
        if self.variant == Variant::Paper {
            let means = &n.stress_mean_kpa_per_mm;
            let scales = means.iter().zip(&n.stress_deviation_kpa_per_mm);
            for ((input, s), (mean, deviation)) in inputs.iter_mut().zip(seen).zip(scales) {
                *input = ((s - mean) / deviation) as f32;
            }
        } else {
            for ((input, p), rms) in inputs.iter_mut().zip(seen).zip(&n.pressure_rms_kpa) {
                *input = (p / rms) as f32;
            }
        }
    }

    pub(crate) fn n_taxels(&self) -> usize {
        self.gains.gain.len()
    }

    pub(crate) fn n_time_constants(&self) -> usize {
        if self.variant.has_memory() {
            self.gains.time_constants_s.len()
        } else {
            0
        }
    }

    /// Ratio of readings of order one to inputs of order one, without learned changes;
    /// `[n_taxels]`.
    pub(crate) fn start_gains(&self) -> Vec<f32> {
        let n = &self.normalization;
        let gains = self.gains.gain.iter().zip(&n.pressure_rms_kpa);
        gains
            .map(|(gain, rms)| (gain * rms / n.reading_kpa) as f32)
            .collect()
    }

    /// Relative growth of readings of order one; `[n_taxels]`.
    pub(crate) fn stiffening(&self) -> Vec<f64> {
        let growth = self.gains.stiffening_per_kpa.iter();
        growth
            .map(|per_kpa| per_kpa * self.normalization.reading_kpa)
            .collect()
    }

    /// Overstress shares before the softplus; `[n_time_constants][n_taxels]`, row by row.
    pub(crate) fn start_memory(&self) -> Vec<f32> {
        let inverse_softplus = |share: f64| share.max(SMALLEST_MEMORY).exp_m1().ln();
        (0..self.n_time_constants())
            .flat_map(|j| {
                self.gains
                    .memory
                    .iter()
                    .map(move |shares| inverse_softplus(shares[j]) as f32)
            })
            .collect()
    }
}
