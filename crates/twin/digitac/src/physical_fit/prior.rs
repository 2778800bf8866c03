//! Prior knowledge about a sensor before it was pressed: it resembles another one.
//!
//! Each unknown has a normal distribution about a learned value, with a width that is typical of
//! two casts of one description. The weight of this prior depends on the number of presses: the
//! more presses, the weaker the regularization.

use crate::numerics::Unknown;

/// Typical error of a twin of another sensor over the largest reading: deviations of this size
/// carry no information.
const USUAL_DEVIATION: f64 = 0.01;
/// Number of independent readings of a press. Its frames follow each other closely, so their
/// deviations are similar.
const READINGS_OF_PRESS: f64 = 4.0;

/// Weight of a prior relative to a mean absolute deviation of all readings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Prior {
    /// Cost of one unit of the logarithm of likelihood.
    cost: f64,
}

impl Prior {
    /// The prior for a fit to this many presses.
    pub(crate) fn beside(n_presses: usize) -> Self {
        Self {
            cost: USUAL_DEVIATION / (READINGS_OF_PRESS * n_presses.max(1) as f64),
        }
    }

    /// Regularizes an unknown towards a value, where the search also starts, with the strength of a
    /// normal distribution of this width.
    pub(crate) fn pull(&self, unknown: &mut Unknown, center: f64, width: f64) {
        (unknown.start, unknown.center) = (center, center);
        unknown.pull = 0.5 * self.cost / width.powi(2);
    }

    /// Converts a press's part of the cost's curvature, for deviations of one and weights of
    /// `n_presses` that add up to one, into its information about the unknowns.
    pub(crate) fn information(curvature: &mut [f64], n_presses: usize) {
        let of_press = READINGS_OF_PRESS * n_presses as f64 / USUAL_DEVIATION.powi(2);
        curvature.iter_mut().for_each(|value| *value *= of_press);
    }

    /// Prior information about an unknown.
    pub(crate) fn known(&self, unknown: &Unknown) -> f64 {
        2.0 * unknown.pull / self.cost
    }

    /// Covariance of the unknowns, from the inverse of the cost's curvature.
    pub(crate) fn covariance(&self, mut inverse_curvature: Vec<f64>) -> Vec<f64> {
        inverse_curvature.iter_mut().for_each(|value| *value *= self.cost);
        inverse_curvature
    }
}

/// Differences between the barometers of two casts: standard deviations of the unknowns of a fit.
pub(super) struct BarometerWidths {
    pub(super) ln_time_constant: f64,
    /// Relative growth at the largest reading.
    pub(super) common_growth: f64,
    pub(super) own_growth: f64,
    pub(super) common_ln_gain: f64,
    pub(super) own_ln_gain: f64,
    /// Share of an overstress in the reading.
    pub(super) share: f64,
}

impl BarometerWidths {
    /// Gains of the chips of one gel differ by up to a factor of 2.8, those of different gels by
    /// more. Relaxation differs from chip to chip.
    pub(super) const USUAL: Self = Self {
        ln_time_constant: 0.6,
        common_growth: 0.3,
        own_growth: 0.15,
        common_ln_gain: 1.0,
        own_ln_gain: 0.2,
        share: 0.15,
    };
}
