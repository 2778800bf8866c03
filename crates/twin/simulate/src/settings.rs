//! How finely a press is simulated.

use serde::{Deserialize, Serialize};
use twintac_softbody::SolverSettings;

/// Settings of a simulated press.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SimulateSettings {
    /// Edges over the gel's height, away from the indenter; the pressure has half as many.
    pub edges_per_height: f64,
    /// Edges across the radius of the contact at full depth; never longer than away from the indenter. The pressure has half as many.
    pub edges_per_contact_radius: f64,
    /// Length of the edges under the indenter, mm, instead of `edges_per_contact_radius`; never longer than away from it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_edge_mm: Option<f64>,
    /// Largest number of nodes of the mesh for a table. If the requested edges give more, all edges are made longer.
    pub max_nodes: usize,
    /// Number of nodes of the mesh for a path, which bounds its computing time: edges are made shorter or longer than requested to come close
    /// to it. Meshes that are refined at the indenter's rim get two thirds more.
    pub max_path_nodes: usize,
    /// Edges along a path over the radius to which an indenter is rounded, where that makes them shorter than elsewhere: the force of a punch comes
    /// from its rim. The pressure has half as many. Not used for tables.
    pub edges_per_rounding: f64,
    /// Mean distance of a table's frames over depth, mm. Shallow tables have five.
    pub depth_step_mm: f64,
    /// The solver's own settings.
    pub solver: SolverSettings,
}

impl SimulateSettings {
    /// Frames of the shallowest table, after the untouched one.
    pub(crate) const MIN_DEPTH_STEPS: f64 = 5.0;

    /// For single presses that are looked at closely: twice as long as the default, which is for tables that a twin is trained on.
    #[must_use]
    pub fn fine() -> Self {
        Self {
            edges_per_height: 8.0,
            edges_per_contact_radius: 7.0,
            solver: SolverSettings {
                tolerance: 1e-4,
                max_iterations: 100,
                ..Self::default().solver
            },
            ..Self::default()
        }
    }
}

impl Default for SimulateSettings {
    fn default() -> Self {
        Self {
            edges_per_height: 6.0,
            edges_per_contact_radius: 6.0,
            contact_edge_mm: None,
            max_nodes: 16_000,
            max_path_nodes: 20_000,
            edges_per_rounding: 2.0,
            depth_step_mm: 0.3,
            solver: SolverSettings {
                tolerance: 1e-3,
                // A table that ends a little early costs less than the search for where exactly it has to.
                max_iterations: 40,
                min_substep: 0.25,
                ..SolverSettings::default()
            },
        }
    }
}
