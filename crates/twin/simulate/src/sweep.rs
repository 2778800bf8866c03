//! A press at one place, from first touch to full depth.
//!
//! The elastic gel without friction has no memory: what it does at a depth does not depend on how it got there. So a place is
//! simulated once as a table over depth, and any press there, at any speed and with any holds, is read off the table.

use serde::{Deserialize, Serialize};
use twintac_shape::Pose;
use twintac_softbody::Frame;

/// How far a simulated frame can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Honesty {
    /// Whether the residual fell below the tolerance.
    pub converged: bool,
    /// Newton iterations.
    pub iterations: u32,
    /// Residual force over the indenter's force.
    pub residual: f64,
    /// Largest depth of a gel node inside a rigid body, mm.
    pub penetration_mm: f64,
    /// Smallest volume ratio of a tetrahedron.
    pub smallest_volume_ratio: f64,
    /// Wall time, s. Not part of any result that has to repeat.
    #[serde(skip)]
    pub wall_time_s: f64,
}

impl Honesty {
    pub(crate) fn of(frame: &Frame) -> Self {
        Self {
            converged: frame.converged,
            iterations: frame.iterations,
            residual: frame.residual,
            penetration_mm: frame.penetration_mm,
            smallest_volume_ratio: frame.smallest_volume_ratio,
            wall_time_s: frame.wall_time_s,
        }
    }
}

/// The gel at one depth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepFrame {
    /// Time, s; zero throughout a table over depth.
    pub time_s: f64,
    /// Depth below first touch, mm.
    pub depth_mm: f64,
    /// Force of the indenter on the gel along -z, N.
    pub force_n: f64,
    /// Hydrostatic pressure -tr(σ)/3, averaged over each taxel's port, kPa; `[n_taxels]`.
    pub port_pressure_kpa: Vec<f64>,
    /// The stress feature of TwinTac (arXiv 2509.10063, equation 6): mean over the surface nodes above each taxel of von Mises stress over
    /// distance to the taxel, kPa/mm; `[n_taxels]`.
    pub stress_feature_kpa_per_mm: Vec<f64>,
    /// How far to trust it.
    pub honesty: Honesty,
}

/// A table over depth at one place. The first frame is the untouched gel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// The indenter's name.
    pub indenter: String,
    /// The indenter at first touch.
    pub gel_from_indenter_at_touch: Pose,
    /// Nodes of the mesh.
    pub n_nodes: usize,
    /// Frames at increasing depth, or in time for a press that follows a trajectory.
    pub frames: Vec<SweepFrame>,
    /// Why the frames end before they should; `None` if they do not.
    pub failure: Option<String>,
}

impl Sweep {
    /// Depth of the last frame, mm.
    #[must_use]
    pub fn depth_mm(&self) -> f64 {
        self.frames.last().map_or(0.0, |frame| frame.depth_mm)
    }
}
