//! What is known of a sensor before it was pressed: that it is like another one.
//!
//! Each unknown is taken to lie about a learned value, with a width that two casts of one description may differ by. How much presses weigh
//! against that is decided by their number: the more presses, the less pull.

use crate::numerics::Unknown;

/// By how much a twin of another sensor errs, over the largest reading: the size of a deviation that says nothing.
const USUAL_DEVIATION: f64 = 0.01;
/// Independent readings of a press. Its frames follow each other closely, so that their deviations are alike.
const READINGS_OF_PRESS: f64 = 4.0;

/// How much a prior weighs beside a mean absolute deviation of all readings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Prior {
    /// Cost of one unit of the logarithm of likelihood.
    cost: f64,
}

impl Prior {
    /// Beside so many presses.
    pub(crate) fn beside(n_presses: usize) -> Self {
        Self {
            cost: USUAL_DEVIATION / (READINGS_OF_PRESS * n_presses.max(1) as f64),
        }
    }

    /// Pulls an unknown to a value, where the search starts, as strongly as a normal distribution of this width does.
    pub(crate) fn pull(&self, unknown: &mut Unknown, center: f64, width: f64) {
        (unknown.start, unknown.center) = (center, center);
        unknown.pull = 0.5 * self.cost / width.powi(2);
    }

    /// How much one press says of the unknowns, from its part of the cost's curvature for deviations of one, where the weights of `n_presses` add up
    /// to one.
    pub(crate) fn information(curvature: &mut [f64], n_presses: usize) {
        let of_press = READINGS_OF_PRESS * n_presses as f64 / USUAL_DEVIATION.powi(2);
        curvature.iter_mut().for_each(|value| *value *= of_press);
    }

    /// How much is known of an unknown beforehand.
    pub(crate) fn known(&self, unknown: &Unknown) -> f64 {
        2.0 * unknown.pull / self.cost
    }

    /// What is left unknown, from the inverse of the cost's curvature.
    pub(crate) fn covariance(&self, mut inverse_curvature: Vec<f64>) -> Vec<f64> {
        inverse_curvature.iter_mut().for_each(|value| *value *= self.cost);
        inverse_curvature
    }
}

/// By how much barometers of two casts differ: standard deviations of the unknowns of a fit.
pub(super) struct BarometerWidths {
    pub(super) ln_time_constant: f64,
    /// At the largest reading.
    pub(super) common_growth: f64,
    pub(super) own_growth: f64,
    pub(super) common_ln_gain: f64,
    pub(super) own_ln_gain: f64,
    /// Of an overstress in the reading.
    pub(super) share: f64,
}

impl BarometerWidths {
    /// Chips of one gel differ by up to a factor of 2.8 in gain, gels by more; relaxation differs from chip to chip.
    pub(super) const USUAL: Self = Self {
        ln_time_constant: 0.6,
        common_growth: 0.3,
        own_growth: 0.15,
        common_ln_gain: 1.0,
        own_ln_gain: 0.2,
        share: 0.15,
    };
}
