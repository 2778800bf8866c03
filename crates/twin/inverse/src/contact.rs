//! What touches.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::model::Press;

/// What touches, with how sure that is. Deviations are standard deviations, as the settings' noise and model errors make them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Number of the most probable shape, of which the rest is said.
    pub shape: usize,
    /// How probable each of the known shapes is; `[n_shapes]`, sums up to 1.
    pub shape_probabilities: Vec<f64>,
    /// Place of the shape's origin in the gel's plane, mm.
    pub place_mm: DVec2,
    /// Depth below first touch, mm.
    pub depth_mm: f64,
    /// Turn about the vertical, radians, up to what makes no difference to the shape; 0 for a round one.
    pub spin_rad: f64,
    /// Force into the gel, N.
    pub force_n: f64,
    /// Deviation of the place along x and along y, mm.
    pub place_deviation_mm: DVec2,
    /// Deviation of the depth, mm.
    pub depth_deviation_mm: f64,
    /// Deviation of the spin, radians; 0 for a round shape.
    pub spin_deviation_rad: f64,
    /// Deviation of the force, N.
    pub force_deviation_n: f64,
    /// Covariance of x, y and depth, mm, and spin, radians.
    pub covariance: [[f64; 4]; 4],
    /// What the shape leaves of the readings, as a root mean square in deviations of a frame by itself: far above 1, something else touches.
    pub misfit: f64,
}

impl Contact {
    /// How the shape presses.
    #[must_use]
    pub fn press(&self) -> Press {
        Press {
            place_mm: self.place_mm,
            depth_mm: self.depth_mm,
            spin_rad: self.spin_rad,
        }
    }
}
