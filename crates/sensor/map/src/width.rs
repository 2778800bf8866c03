//! The Gaussian's width, chosen by leave-one-out cross-validation.

use crate::geometry::{finite_or_zero, pitch_mm};
use crate::{Kernel, kernel};

/// Widths that are tried, in pitches of the taxels, each 1.12 times the last. With larger widths
/// the weights are dominated by rounding errors.
const NARROWEST: f64 = 0.3;
const STEP: f64 = 1.12;
const STEPS: i32 = 13;
/// The width if the fields give no information, in pitches.
const USUAL: f64 = 0.5;

/// The width of Gaussians, mm, with the smallest leave-one-out error, summed over taxels and
/// fields.
///
/// A field has one reading above the baseline for each taxel, kPa. Leaving one out needs no
/// solution of its own: its error is `wᵢ / (K⁻¹)ᵢᵢ` (Rippa 1999). The width is half the pitch if
/// there are no fields, if all are zero, or if there are fewer than three taxels.
pub(crate) fn leave_one_out_width_mm(taxels_mm: &[[f64; 2]], fields_kpa: &[&[f64]], ridge: f64) -> f64 {
    let pitch_mm = pitch_mm(taxels_mm);
    let is_told = |field: &&&[f64]| {
        field.len() == taxels_mm.len() && field.iter().any(|value| finite_or_zero(*value) != 0.0)
    };
    let fields: Vec<&[f64]> = fields_kpa.iter().filter(is_told).copied().collect();
    if taxels_mm.len() < 3 || fields.is_empty() {
        return USUAL * pitch_mm;
    }
    let (mut best_mm, mut least) = (USUAL * pitch_mm, f64::INFINITY);
    for step in 0..STEPS {
        let width_mm = NARROWEST * STEP.powi(step) * pitch_mm;
        let system = kernel::system(Kernel::Gaussian, taxels_mm, width_mm, ridge, &[]);
        let Ok(inverse) = kernel::inverse(system) else {
            continue;
        };
        let misses = fields.iter().flat_map(|field| {
            inverse.iter().enumerate().map(|(taxel, row)| {
                let weight: f64 = row
                    .iter()
                    .zip(*field)
                    .map(|(entry, above)| entry * finite_or_zero(*above))
                    .sum();
                (weight / row[taxel]).powi(2)
            })
        });
        let sum: f64 = misses.sum();
        if sum < least {
            (best_mm, least) = (width_mm, sum);
        }
    }
    best_mm
}
