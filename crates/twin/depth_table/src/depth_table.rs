//! A table over depth at one location, and its frames.

use serde::{Deserialize, Serialize};
use twintac_shape::Pose;

/// Solve quality of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SolveQuality {
    /// Newton iterations.
    pub iterations: u32,
    /// Residual force over the indenter's force.
    pub residual: f64,
    /// Largest depth of a gel node inside a rigid body, mm.
    pub penetration_mm: f64,
    /// Smallest volume ratio of a tetrahedron.
    pub smallest_volume_ratio: f64,
    /// Wall time, s. It is not reproducible, and no result depends on it.
    #[serde(skip)]
    pub wall_time_s: f64,
}

/// The gel at one moment of a press.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PressFrame {
    /// Depth below first touch, mm.
    pub depth_mm: f64,
    /// Force of the indenter on the gel along -z, N.
    pub force_n: f64,
    /// Hydrostatic pressure -tr(σ)/3, averaged over each taxel's port, kPa; `[n_taxels]`.
    pub port_pressure_kpa: Vec<f64>,
    /// Derivatives of that pressure with respect to the port's x, y and radius, kPa/mm;
    /// `[n_taxels]`.
    pub port_slope_kpa_per_mm: Vec<[f64; 3]>,
    /// The stress feature of TwinTac (arXiv 2509.10063, equation 6): the mean over the surface
    /// nodes above each taxel of von Mises stress over distance to the taxel, kPa/mm; `[n_taxels]`.
    pub stress_feature_kpa_per_mm: Vec<f64>,
    /// Quality of the solve.
    pub quality: SolveQuality,
}

/// A table over depth at one location. The first frame is the untouched gel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DepthTable {
    /// The indenter's name.
    pub indenter: String,
    /// The indenter at first touch.
    pub gel_from_indenter_at_touch: Pose,
    /// Nodes of the mesh.
    pub n_nodes: usize,
    /// Frames at increasing depth.
    pub frames: Vec<PressFrame>,
    /// Why the frames end before the requested depth; `None` if they reach it.
    pub failure: Option<String>,
}

impl DepthTable {
    /// Depth of the last frame, mm.
    #[must_use]
    pub fn depth_mm(&self) -> f64 {
        self.frames.last().map_or(0.0, |frame| frame.depth_mm)
    }
}
