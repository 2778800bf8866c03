//! A step to solve, its unknowns, and how it can end.

use glam::DVec3;

use crate::contact::{Contact, PassedThrough, Pulled, RigidBody};
use crate::element::Response;

/// A step to solve: everything that is fixed while the displacements are computed.
pub(crate) struct Step<'a> {
    pub(crate) response: Response<'a>,
    pub(crate) shapes: &'a [RigidBody<'a>],
}

/// Unknowns of a step.
pub(crate) struct Unknowns<'a> {
    pub(crate) displacements_mm: &'a mut Vec<DVec3>,
    pub(crate) pressures_mpa: &'a mut Vec<f64>,
    pub(crate) contacts: &'a mut Vec<Contact>,
}

/// Where an iteration starts.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Start {
    /// With a new step.
    Anew,
    /// At the end of an iteration for the same step, with other contact points.
    Again,
    /// Where a deadline ended the same step.
    GoOn,
}

/// Unknowns before a step.
#[derive(Clone, Default)]
pub(crate) struct Beginning {
    pub(crate) displacements_mm: Vec<DVec3>,
    pub(crate) pressures_mpa: Vec<f64>,
    pub(crate) contacts: Vec<Contact>,
}

/// An equilibrium on the way to the end of a step, and its contacts before their multipliers were
/// updated.
pub(crate) struct Passed {
    pub(crate) displacements_mm: Vec<DVec3>,
    pub(crate) pressures_mpa: Vec<f64>,
    pub(crate) contacts: Vec<Contact>,
}

/// Why a step failed.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Failure {
    NotConverged { residual: f64 },
    Inverted,
    Singular,
    PassedThrough(PassedThrough),
    Pulled(Pulled),
}

/// The end of a step that succeeded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Equilibrium {
    pub(crate) residual: f64,
    pub(crate) smallest_volume_ratio: f64,
    /// Whether the forces are balanced; otherwise a deadline has passed, in this step or before.
    pub(crate) is_settled: bool,
}

/// Energy, and the size of its gradient, at given displacements.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Evaluation {
    pub(crate) energy: f64,
    pub(super) smallest_volume_ratio: f64,
    /// 2-norm of the gradient at free nodes, N.
    pub(super) unbalanced_n: f64,
    /// Sum of the magnitudes of all external forces, N.
    pub(super) load_n: f64,
}
