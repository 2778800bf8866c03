//! The result of a step.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The result of a step. Forces act on the gel and are in the gel's frame; their sum is zero except
/// for the residual.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Force of the indenter, N.
    pub indenter_force_n: DVec3,
    /// Torque of the indenter about the indenter's origin, N mm.
    pub indenter_torque_n_mm: DVec3,
    /// Force of everything that the gel is bonded to, N.
    pub board_reaction_n: DVec3,
    /// Force of all obstacles, N.
    pub obstacle_reaction_n: DVec3,
    /// Whether this is the equilibrium at the indenter's pose. A step that does not converge is an
    /// error, unless its deadline has passed ([`crate::State::answer_within`]): then `residual`
    /// states how much is unbalanced, and `behind_mm` how far the indenter has still to move.
    pub converged: bool,
    /// Distance of the indenter's pose in the solution from the pose that was asked for, mm; a turn
    /// counts as the way of the indenter's farthest point. 0 without a deadline.
    pub behind_mm: f64,
    /// Newton iterations, including those of failed sub-steps.
    pub iterations: u32,
    /// 2-norm of the unbalanced nodal forces, divided by the load.
    pub residual: f64,
    /// Largest depth of a node inside a shape, mm.
    pub penetration_mm: f64,
    /// Smallest ratio of the volume at a point to its undeformed volume, of the quadrature points,
    /// and of the corners of blended and quadratic elements.
    pub smallest_volume_ratio: f64,
    /// Wall time, s.
    pub wall_time_s: f64,
    /// How the time was spent.
    pub cost: Cost,
}

/// How the time of a step was spent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Energy and forces of the elements, s.
    pub forces_s: f64,
    /// Distances to shapes, and contact forces, s.
    pub contact_s: f64,
    /// The matrix of the linear system, s.
    pub assembly_s: f64,
    /// Factorization of the coarse system, s.
    pub factorisation_s: f64,
    /// Conjugate gradients, s.
    pub linear_solve_s: f64,
    /// Number of factorizations of the coarse system.
    pub factorisations: u32,
    /// Number of iterations of conjugate gradients.
    pub linear_iterations: u32,
}
