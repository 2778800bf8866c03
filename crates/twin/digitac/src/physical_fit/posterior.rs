//! The result of a fit near learned values, with its uncertainty.

use super::layout::Layout;
use crate::Gains;

/// Step of an unknown for difference quotients.
const STEP: f64 = 1e-5;

/// The fitted values and their covariance.
pub(crate) struct Posterior {
    pub(crate) gains: Gains,
    /// Weighted mean of the absolute deviations over the largest readings.
    pub(crate) deviation: f64,
    pub(super) layout: Layout,
    /// Values of all unknowns; `[n]`.
    pub(super) x: Vec<f64>,
    /// Covariance of all unknowns, row by row; `[n * n]`.
    pub(super) covariance: Vec<f64>,
}

impl Posterior {
    /// Values of the unknowns of the port pressures.
    pub(crate) fn values(&self) -> &[f64] {
        self.layout.of_elastic(&self.x)
    }

    /// Standard deviation of a quantity that depends on the unknowns of the port pressures and on
    /// the barometers.
    pub(crate) fn uncertainty(&self, value: &dyn Fn(&[f64], &Gains) -> f64) -> f64 {
        let n = self.x.len();
        let at = |x: &[f64]| {
            value(
                self.layout.of_elastic(x),
                &self.layout.gains(x, self.gains.gain.len()),
            )
        };
        let slope = |i: usize| {
            let moved = |by: f64| {
                let mut x = self.x.clone();
                x[i] += by;
                at(&x)
            };
            (moved(STEP) - moved(-STEP)) / (2.0 * STEP)
        };
        let slopes: Vec<f64> = (0..n).map(slope).collect();
        let row = |i: usize| -> f64 {
            let covariances = &self.covariance[i * n..(i + 1) * n];
            covariances.iter().zip(&slopes).map(|(c, slope)| c * slope).sum()
        };
        let variance: f64 = slopes.iter().enumerate().map(|(i, slope)| slope * row(i)).sum();
        variance.max(0.0).sqrt()
    }
}
