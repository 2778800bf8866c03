//! How finely a press is simulated.

use serde::{Deserialize, Serialize};
use twintac_softbody::SolverSettings;

/// Settings of a simulated press.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SimulateSettings {
    /// Edge length of tetrahedra away from the indenter, mm.
    pub edge_mm: f64,
    /// Edges across the radius of the contact at full depth. The edge length under the indenter is that radius over this number, within
    /// `smallest_edge_mm` and `edge_mm`.
    pub edges_per_contact_radius: f64,
    /// Smallest edge length under the indenter, mm.
    pub smallest_edge_mm: f64,
    /// Frames of a sweep over depth, after the untouched one.
    pub sweep_frames: u32,
    /// The solver's own settings.
    pub solver: SolverSettings,
}

impl Default for SimulateSettings {
    fn default() -> Self {
        Self {
            edge_mm: 1.5,
            edges_per_contact_radius: 4.0,
            smallest_edge_mm: 0.3,
            sweep_frames: 10,
            solver: SolverSettings::default(),
        }
    }
}
