//! The correction factor for differences between the real and the simulated tip and gel: a tip that
//! is not a ball, a gel that stiffens, friction.
//!
//! It multiplies every port pressure and is a smooth function of the port's distance and of the
//! depth, the same for all ports. It is 1 where presses do not determine it.

use serde::{Deserialize, Serialize};

use crate::numerics::mirrored_splines;

/// Intervals of the function of distance.
const N_INTERVALS: usize = 5;
/// Number of splines over the distance.
const N_SPLINES: usize = N_INTERVALS + 2;
/// Splines of one port's distance.
pub(crate) type DistanceSplines = [f64; N_SPLINES];
/// Number of powers of the logarithm of depth, from zero.
const N_POWERS: usize = 3;
/// Number of terms of the function.
pub(crate) const N_TERMS: usize = N_SPLINES * N_POWERS;
/// Depths below this fraction of the largest are replaced by it.
const SHALLOWEST: f64 = 0.05;

/// The correction factor on port pressures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SmoothFactor {
    /// Locations of the ports in the gel's plane, mm; `[n_taxels]`.
    pub(crate) ports_mm: Vec<[f64; 2]>,
    /// Distance beyond which the factor is constant, mm.
    pub(crate) reach_mm: f64,
    /// Largest training depth, mm, beyond which the factor is constant.
    pub(crate) depth_mm: f64,
    /// `[N_SPLINES * N_POWERS]`.
    pub(crate) coefficients: Vec<f64>,
}

impl SmoothFactor {
    /// The splines of a port's distance from a location.
    pub(crate) fn splines(&self, taxel: usize, place_mm: [f64; 2]) -> [f64; N_SPLINES] {
        let port = self.ports_mm[taxel];
        let distance_mm = (port[0] - place_mm[0]).hypot(port[1] - place_mm[1]);
        mirrored_splines((distance_mm / self.reach_mm).min(1.0) * N_INTERVALS as f64)
    }

    /// The terms of the function. Their sum, weighted with the coefficients, is the factor's
    /// logarithm.
    pub(crate) fn terms(&self, splines: &[f64; N_SPLINES], depth_mm: f64) -> [f64; N_TERMS] {
        let logarithm = (depth_mm / self.depth_mm).clamp(SHALLOWEST, 1.0).ln();
        std::array::from_fn(|term| splines[term / N_POWERS] * logarithm.powi((term % N_POWERS) as i32))
    }

    /// The factor at a depth.
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
