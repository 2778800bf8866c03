//! How finely a press is simulated.

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, Ranges};
use twintac_softbody::SolverSettings;

/// Settings of a simulated press.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SimulateSettings {
    /// Number of edges over the gel's height, away from the indenter. The pressure has half as
    /// many.
    pub edges_per_height: f64,
    /// Number of edges across the radius of the contact at full depth. These edges are never longer
    /// than those away from the indenter, and never shorter than a 20th of them. The pressure has
    /// half as many.
    pub edges_per_contact_radius: f64,
    /// Length of the edges under the indenter, mm, instead of `edges_per_contact_radius`; within
    /// the same limits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_edge_mm: Option<f64>,
    /// Largest number of nodes of the mesh for a table. If the requested edges give more, all edges
    /// are made longer.
    pub max_nodes: usize,
    /// Number of nodes of the mesh for a path, which bounds its computing time. Edges are made
    /// shorter or longer than requested to come close to it. Meshes that are refined at the
    /// indenter's rim may have 60 % more.
    pub max_path_nodes: usize,
    /// Number of edges over the radius to which an indenter's rim is rounded, because the force of
    /// a punch comes from its rim. It counts only where it makes edges shorter than elsewhere. The
    /// edges at a rim are not shorter than half of those under the rest of the indenter, or 45 %
    /// for a path. The pressure has half as many.
    pub edges_per_rounding: f64,
    /// Mean distance between a table's frames over depth, mm. A table has at least five steps.
    pub depth_step_mm: f64,
    /// The solver's own settings. Meshes of paths that are refined at the indenter's rim have the
    /// element [`Element::Blended`](twintac_softbody::Element::Blended) in place of the default.
    pub solver: SolverSettings,
}

impl Checked for SimulateSettings {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            edges_per_height,
            edges_per_contact_radius,
            contact_edge_mm,
            max_nodes,
            max_path_nodes,
            edges_per_rounding,
            depth_step_mm,
            solver,
        } = self;
        ranges.number("edges_per_height", *edges_per_height, 1.0..=30.0);
        ranges.number("edges_per_contact_radius", *edges_per_contact_radius, 0.5..=50.0);
        if let Some(edge_mm) = contact_edge_mm {
            ranges.number("contact_edge_mm", *edge_mm, 0.01..=20.0);
        }
        ranges.number("max_nodes", *max_nodes, 100.0..=1e6);
        ranges.number("max_path_nodes", *max_path_nodes, 100.0..=1e6);
        ranges.number("edges_per_rounding", *edges_per_rounding, 0.1..=20.0);
        ranges.number("depth_step_mm", *depth_step_mm, 0.01..=5.0);
        ranges.inside("solver", &Solver(solver));
    }
}

/// The solver's settings as users write them. The accepted ranges are those that the solver takes
/// and that end in a finite time.
struct Solver<'a>(&'a SolverSettings);

impl Checked for Solver<'_> {
    fn check(&self, ranges: &mut Ranges) {
        let SolverSettings {
            element: _,
            linear: _,
            tolerance,
            max_iterations,
            max_travel_mm,
            min_substep,
            contact_stiffness,
            penetration_mm,
            friction,
            obstacle_friction,
        } = self.0;
        ranges.number("tolerance", *tolerance, 1e-12..=0.1);
        ranges.number("max_iterations", *max_iterations, 1.0..=10_000.0);
        ranges.number("max_travel_mm", *max_travel_mm, 1e-3..=10.0);
        ranges.number("min_substep", *min_substep, 1e-6..=1.0);
        ranges.number("contact_stiffness", *contact_stiffness, 0.1..=1e6);
        ranges.number("penetration_mm", *penetration_mm, 1e-6..=1.0);
        ranges.zero_or("friction", *friction, 1e-6..=10.0);
        ranges.zero_or("obstacle_friction", *obstacle_friction, 1e-6..=10.0);
    }
}

impl SimulateSettings {
    /// Smallest number of frames of a table, without the untouched one.
    pub(crate) const MIN_DEPTH_STEPS: f64 = 5.0;

    /// For single presses that are examined closely. They take twice as long as with the default,
    /// which is for the tables that a twin is trained on.
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
                // A table that ends a little early costs less than the search for the exact depth
                // at which it has to end.
                max_iterations: 40,
                min_substep: 0.25,
                ..SolverSettings::default()
            },
        }
    }
}
