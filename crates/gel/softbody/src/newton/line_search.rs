//! A line search down the energy.

use super::step::{Evaluation, Failure, Step, Unknowns};
use super::workspace::Buffers;
use crate::body::SoftBody;
use crate::nodal::dot;

/// Largest number of trial steps of a line search, after which the direction fails.
const MAX_TRIALS: u32 = 20;

/// Fraction of the decrease predicted by the slope that a trial step must reach (Armijo).
const SUFFICIENT_DECREASE: f64 = 1e-4;

/// Longest step, in units of the direction. Where a node slips off an edge, the energy is concave
/// and the direction too short.
const MAX_STRETCH: f64 = 16.0;

/// A trial is accepted if its slope is below this fraction of that at the start.
const FLAT: f64 = 0.5;

/// A change below this fraction of the energy, and of the shear modulus times the volume, is
/// round-off; then the slope decides.
const ROUND_OFF: f64 = 1e-13;

impl Buffers {
    /// Finds a step along the direction to approximately the lowest energy. Trials cost little
    /// compared with a direction.
    pub(super) fn search(
        &mut self,
        body: &SoftBody,
        step: &Step,
        x: &mut Unknowns,
        start: &Evaluation,
    ) -> Result<(Evaluation, f64), Failure> {
        let slope_at_start = dot(&self.gradient_n, &self.direction_mm);
        let round_off = ROUND_OFF * (start.energy.abs() + body.energy_scale_n_mm());
        self.start_mm.copy_from_slice(x.displacements_mm);
        self.start_mpa.copy_from_slice(x.pressures_mpa);
        // At `low`, the best trial so far, the energy still falls. Beyond `high` it rises, or a
        // tetrahedron is inverted.
        let (mut low, mut slope_at_low, mut is_usable) = (0.0, slope_at_start, false);
        let (mut high, mut slope_at_high) = (f64::INFINITY, None);
        let mut length = 1.0;
        for _ in 0..MAX_TRIALS {
            let trial = self.try_length(body, step, x, length);
            let slope = dot(&self.gradient_n, &self.direction_mm);
            let falls = trial.is_some_and(|trial| {
                let change = trial.energy - start.energy;
                change <= SUFFICIENT_DECREASE * length * slope_at_start
                    || (change.abs() <= round_off && slope.abs() <= 0.9 * slope_at_start.abs())
            });
            match trial {
                Some(trial)
                    if falls
                        && (slope.abs() <= FLAT * slope_at_start.abs()
                            || slope < 0.0 && length >= MAX_STRETCH) =>
                {
                    return Ok((trial, length));
                }
                Some(_) if falls && slope < 0.0 => {
                    (low, slope_at_low, is_usable) = (length, slope, true);
                    if high.is_infinite() {
                        length *= 2.0;
                        continue;
                    }
                }
                Some(_) => (high, slope_at_high) = (length, (slope > 0.0).then_some(slope)),
                None => (high, slope_at_high) = (length, None),
            }
            if is_usable && high - low < 0.1 * high {
                break;
            }
            // The zero of a line through both slopes, limited to the inner part of the interval.
            let part = slope_at_high.map_or(0.5, |high| slope_at_low / (slope_at_low - high));
            length = low + part.clamp(0.1, 0.9) * (high - low);
        }
        let trial = self.try_length(body, step, x, low);
        match trial {
            Some(trial) if is_usable => Ok((trial, low)),
            _ if slope_at_high.is_none() => Err(Failure::Inverted),
            _ => Err(Failure::NotConverged { residual: f64::NAN }),
        }
    }

    fn try_length(
        &mut self,
        body: &SoftBody,
        step: &Step,
        x: &mut Unknowns,
        length: f64,
    ) -> Option<Evaluation> {
        for ((u, start), direction) in x
            .displacements_mm
            .iter_mut()
            .zip(&self.start_mm)
            .zip(&self.direction_mm)
        {
            *u = *start + *direction * length;
        }
        self.evaluate(body, step, x)
    }
}
