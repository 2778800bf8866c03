//! Where a soft body is, and what a step reports.

use glam::DVec3;
use serde::Serialize;
use twintac_shape::Pose;

use crate::contact::Contact;
use crate::newton::Workspace;
use crate::relaxation::Memory;
use crate::sensitivity::Sensitivity;

/// Where a soft body is: what one press changes. Made by [`crate::SoftBody::rest`].
#[derive(Clone)]
pub struct State {
    pub(crate) displacements_mm: Vec<DVec3>,
    pub(crate) pressures_mpa: Vec<f64>,
    pub(crate) memory: Memory,
    /// The indenter first, then the obstacles.
    pub(crate) contacts: Vec<Contact>,
    pub(crate) gel_from_indenter: Option<Pose>,
    /// Last accepted motion, to start the next from.
    pub(crate) last: Option<Motion>,
    /// How the force rose over the way where it was prescribed last, N/mm.
    pub(crate) stiffness_n_per_mm: Option<f64>,
    /// Rates of all of the above along each direction asked for.
    pub(crate) sensitivities: Vec<Sensitivity>,
    pub(crate) workspace: Workspace,
}

/// A motion of the indenter, and how the body followed.
#[derive(Clone, Default)]
pub(crate) struct Motion {
    pub(crate) travel_mm: DVec3,
    pub(crate) displacements_mm: Vec<DVec3>,
}

impl State {
    /// Where the indenter is; none before the first step.
    #[must_use]
    pub fn gel_from_indenter(&self) -> Option<Pose> {
        self.gel_from_indenter
    }

    /// How far a node has moved from its place at rest, mm.
    #[must_use]
    pub fn displacement_mm(&self, node: usize) -> DVec3 {
        self.displacements_mm[node]
    }

    /// How far each node has moved from its place at rest, mm. `[n_nodes]`
    #[must_use]
    pub fn displacements_mm(&self) -> &[DVec3] {
        &self.displacements_mm
    }
}

/// What a step came to. Forces act on the gel, in the gel's frame; their sum is zero but for the residual.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Force of the indenter, N.
    pub indenter_force_n: DVec3,
    /// Torque of the indenter about the indenter's origin, N mm.
    pub indenter_torque_n_mm: DVec3,
    /// Force of what the gel is bonded to, N.
    pub board_reaction_n: DVec3,
    /// Force of all obstacles, N.
    pub obstacle_reaction_n: DVec3,
    /// Always true: a step that does not converge is an error. Kept for records of frames.
    pub converged: bool,
    /// Newton iterations, those of sub-steps that were given up included.
    pub iterations: u32,
    /// 2-norm of the unbalanced nodal forces over the load.
    pub residual: f64,
    /// Largest depth of a node inside a shape, mm.
    pub penetration_mm: f64,
    /// Smallest volume of a tetrahedron over its volume at rest.
    pub smallest_volume_ratio: f64,
    /// Time spent, s.
    pub wall_time_s: f64,
    /// What it was spent on.
    pub cost: Cost,
}

/// What a step's time was spent on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// Energy and forces of the elements, s.
    pub forces_s: f64,
    /// Distances to shapes, and contact forces, s.
    pub contact_s: f64,
    /// The matrix of the linear system, s.
    pub assembly_s: f64,
    /// Factors of the coarse system, s.
    pub factorisation_s: f64,
    /// Conjugate gradients, s.
    pub linear_solve_s: f64,
    /// How often the coarse system was factorised.
    pub factorisations: u32,
    /// Iterations of conjugate gradients.
    pub linear_iterations: u32,
}
