//! The estimated contact.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::model::Press;

/// The estimated contact, with its uncertainty. Deviations are standard deviations that follow from
/// the noise and the model errors in the settings.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Index of the most probable shape; all other fields describe it.
    pub shape: usize,
    /// Probability of each known shape; `[n_shapes]`; the sum is 1.
    pub shape_probabilities: Vec<f64>,
    /// Location of the shape's origin in the gel's plane, mm.
    pub place_mm: DVec2,
    /// Depth below first touch, mm.
    pub depth_mm: f64,
    /// Yaw (rotation about the vertical), radians, modulo the shape's symmetry; 0 for a round
    /// shape.
    pub yaw_rad: f64,
    /// Force into the gel, N.
    pub force_n: f64,
    /// Deviation of the location along x and along y, mm.
    pub place_deviation_mm: DVec2,
    /// Deviation of the depth, mm.
    pub depth_deviation_mm: f64,
    /// Deviation of the yaw, radians; 0 for a round shape.
    pub yaw_deviation_rad: f64,
    /// Deviation of the force, N.
    pub force_deviation_n: f64,
    /// Covariance of x, y and depth, mm, and of yaw, radians.
    pub covariance: [[f64; 4]; 4],
    /// Root mean square of the residuals of the readings, in standard deviations of a single frame.
    /// If it is far above 1, something else is in contact.
    pub misfit: f64,
}

impl Contact {
    /// Location, depth and yaw of the shape.
    #[must_use]
    pub fn press(&self) -> Press {
        Press {
            place_mm: self.place_mm,
            depth_mm: self.depth_mm,
            yaw_rad: self.yaw_rad,
        }
    }
}
