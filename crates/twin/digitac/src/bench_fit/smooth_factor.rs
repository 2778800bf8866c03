//! What tip and gel do otherwise than simulated: a tip that is no ball, a gel that stiffens, friction.
//!
//! A factor on every port pressure: a smooth function of the port's distance and of the depth, the same for all ports. It is one where
//! presses do not say otherwise.

use serde::{Deserialize, Serialize};

use crate::numerics::mirrored_splines;

/// Intervals of the function of distance.
const N_INTERVALS: usize = 5;
/// Splines over the distance.
const N_SPLINES: usize = N_INTERVALS + 2;
/// Splines of one port's distance.
pub(crate) type DistanceSplines = [f64; N_SPLINES];
/// Powers of the logarithm of depth, from zero.
const N_POWERS: usize = 3;
/// Terms of the function.
pub(crate) const N_TERMS: usize = N_SPLINES * N_POWERS;
/// Depths below this part of the largest count as this one.
const SHALLOWEST: f64 = 0.05;

/// The smooth factor on port pressures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SmoothFactor {
    /// Places of the ports in the gel's plane, mm; `[n_taxels]`.
    pub(crate) ports_mm: Vec<[f64; 2]>,
    /// Distance from which on the factor does not change, mm.
    pub(crate) reach_mm: f64,
    /// Largest depth that taught, mm: from there on the factor does not change.
    pub(crate) depth_mm: f64,
    /// `[N_SPLINES * N_POWERS]`
    pub(crate) coefficients: Vec<f64>,
}

impl SmoothFactor {
    /// The splines of a port's distance from a place.
    pub(crate) fn splines(&self, taxel: usize, place_mm: [f64; 2]) -> [f64; N_SPLINES] {
        let port = self.ports_mm[taxel];
        let distance_mm = (port[0] - place_mm[0]).hypot(port[1] - place_mm[1]);
        mirrored_splines((distance_mm / self.reach_mm).min(1.0) * N_INTERVALS as f64)
    }

    /// The terms of the function, whose sum with the coefficients is the factor's logarithm.
    pub(crate) fn terms(&self, splines: &[f64; N_SPLINES], depth_mm: f64) -> [f64; N_TERMS] {
        let logarithm = (depth_mm / self.depth_mm).clamp(SHALLOWEST, 1.0).ln();
        std::array::from_fn(|term| splines[term / N_POWERS] * logarithm.powi((term % N_POWERS) as i32))
    }

    /// The factor.
    pub(crate) fn factor(&self, splines: &[f64; N_SPLINES], depth_mm: f64) -> f64 {
        let terms = self.terms(splines, depth_mm);
        terms
            .iter()
            .zip(&self.coefficients)
            .map(|(t, c)| t * c)
            .sum::<f64>()
            .exp()
    }
}
