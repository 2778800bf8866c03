//! The simulated gel along a press.

use serde::{Deserialize, Serialize};

/// The simulated gel along a press. All vectors have the same length, `n_frames`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Features {
    /// Time stamps, s.
    pub time_s: Vec<f64>,
    /// Depth below first touch, mm; negative above the gel.
    pub depth_mm: Vec<f64>,
    /// Force of the indenter on the gel along -z, N.
    pub force_n: Vec<f64>,
    /// Elastic hydrostatic pressure at each taxel's port, kPa; `[n_frames][n_taxels]`.
    pub pressure_kpa: Vec<Vec<f64>>,
    /// Stress feature of the TwinTac paper (arXiv 2509.10063, equation 6), kPa/mm; `[n_frames][n_taxels]`.
    pub stress_kpa_per_mm: Vec<Vec<f64>>,
    /// Whether the frame was simulated: not deeper than the last frame of the place's table.
    pub simulated: Vec<bool>,
}

impl Features {
    /// Number of frames.
    #[must_use]
    pub fn n_frames(&self) -> usize {
        self.time_s.len()
    }
}
