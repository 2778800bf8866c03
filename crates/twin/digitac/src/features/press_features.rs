//! The simulated gel along a press.

use std::ops::Range;

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
    /// Stress feature of the TwinTac paper (arXiv 2509.10063, equation 6), kPa/mm;
    /// `[n_frames][n_taxels]`.
    pub stress_kpa_per_mm: Vec<Vec<f64>>,
    /// Whether the frame was simulated: it is not deeper than the last frame of the location's
    /// table. The last simulated pressures are used for deeper frames.
    pub simulated: Vec<bool>,
    /// Time since the last frame of the previous press, s; `None` if the gel had rested. Relaxation
    /// goes on between presses that follow each other within seconds.
    pub since_previous_s: Option<f64>,
    /// Frames over which readings are set to zero: the last second before the tip comes near the
    /// gel.
    pub zero_frames: Range<usize>,
}

/// Frames at least this high above the gel count as away from it, mm.
const AWAY_MM: f64 = 0.5;
/// Time over which readings are averaged for their zero, s.
const ZERO_WINDOW_S: f64 = 1.0;

impl Features {
    /// Number of frames.
    #[must_use]
    pub fn n_frames(&self) -> usize {
        self.time_s.len()
    }
}

/// The last second before the tip is nearer to the gel than half a millimetre; empty if it never
/// was farther away.
pub(crate) fn zero_frames(time_s: &[f64], depth_mm: &[f64]) -> Range<usize> {
    let end = depth_mm.iter().take_while(|depth| **depth <= -AWAY_MM).count();
    let Some(last_s) = end.checked_sub(1).map(|last| time_s[last]) else {
        return 0..0;
    };
    time_s[..end].partition_point(|t| *t < last_s - ZERO_WINDOW_S)..end
}
