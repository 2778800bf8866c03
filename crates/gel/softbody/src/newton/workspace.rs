//! The scratch memory of Newton's method.

use std::time::Duration;

use glam::DVec3;

use super::step::{Beginning, Evaluation, Passed, Unknowns};
use crate::body::SoftBody;
use crate::clock::Instant;
use crate::element::{CoarseTangent, Forces, Volumes};
use crate::frame::Cost;
use crate::linear::coarse::{Factors, Tangent};
use crate::linear::cycle::Cycle;
use crate::linear::krylov::ConjugateGradients;
use crate::linear::matrix::Matrix;

/// Scratch memory of a press. It is not part of the state: a clone starts without it.
#[derive(Default)]
pub(crate) struct Workspace(Option<Box<Buffers>>);

impl Clone for Workspace {
    fn clone(&self) -> Self {
        Self::default()
    }
}

pub(crate) struct Buffers {
    pub(super) matrix: Matrix,
    /// Whether the matrix led to a good step when it was last used. It is then used again, in this
    /// step and the next.
    pub(crate) has_matrix: bool,
    /// `None` after a direction along which the energy did not fall.
    pub(super) factors: Option<Factors>,
    /// Where factors are made; only presses that make their own factors have it.
    pub(super) tangent: Option<Box<Tangent>>,
    pub(super) cycle: Cycle,
    pub(super) gradients: ConjugateGradients,
    /// `[n_slots]`
    pub(super) coarse_tangents: Vec<CoarseTangent>,
    pub(super) forces: Forces,
    /// Energy and volume ratio of the elements at the last evaluation.
    pub(super) of_elements: Evaluation,
    pub(super) volumes: Volumes,
    /// Pressures of the corners of each slot, MPa.
    pub(super) corners: Vec<[f64; 4]>,
    /// Extra stiffness, in units of the own stiffness of each node, that limits steps.
    pub(super) damping: f64,
    /// Gradient of the energy at each node, N; at bonded nodes, the force that holds them;
    /// `[n_nodes]`.
    pub(crate) gradient_n: Vec<DVec3>,
    /// Positions of the boundary's nodes, mm.
    pub(super) boundary_mm: Vec<DVec3>,
    /// `[n_free]`
    pub(crate) direction_mm: Vec<DVec3>,
    /// Pressures at which the tangent is taken, MPa. They are separate unknowns, as in a mixed
    /// formulation, which the linear systems bring to equilibrium. With the pressures that follow
    /// from the present volumes, the tangent would be a poor guide on the way there.
    pub(super) foreseen_mpa: Vec<f64>,
    pub(super) start_mm: Vec<DVec3>,
    pub(super) start_mpa: Vec<f64>,
    /// The unknowns at the start of the step.
    pub(crate) old: Beginning,
    /// Whether equilibria before an update of the multipliers are stored; and those of the last
    /// step.
    pub(crate) keeps_passed: bool,
    pub(crate) passed: Vec<Passed>,
    /// Deadline of the step, if it has one.
    pub(crate) ends_at: Option<Instant>,
    /// Duration of the last iteration.
    pub(crate) iteration: Duration,
    /// Time spent since this was last read and reset.
    pub(crate) cost: Cost,
}

impl Workspace {
    pub(crate) fn buffers(&mut self, body: &SoftBody) -> &mut Buffers {
        self.0.get_or_insert_with(|| {
            let n_nodes = body.mesh.nodes_mm.len();
            let n_free = body.pattern.halves.free;
            Box::new(Buffers {
                matrix: body.pattern.matrix(),
                has_matrix: false,
                factors: body.rest_factors.clone(),
                tangent: None,
                cycle: Cycle::new(&body.pattern),
                gradients: ConjugateGradients::new(&body.pattern),
                coarse_tangents: vec![CoarseTangent::default(); body.elements.n_slots()],
                forces: Forces::default(),
                of_elements: Evaluation::default(),
                volumes: Volumes::default(),
                corners: Vec::new(),
                damping: 0.0,
                gradient_n: vec![DVec3::ZERO; n_nodes],
                boundary_mm: Vec::new(),
                direction_mm: vec![DVec3::ZERO; n_free],
                foreseen_mpa: vec![0.0; body.volume_stiffness.len()],
                start_mm: vec![DVec3::ZERO; n_nodes],
                start_mpa: vec![0.0; body.volume_stiffness.len()],
                old: Beginning::default(),
                keeps_passed: false,
                passed: Vec::new(),
                ends_at: None,
                iteration: Duration::ZERO,
                cost: Cost::default(),
            })
        })
    }
}

impl Buffers {
    /// Selects the true tangent at the unknowns, which are at equilibrium, for the following
    /// directions.
    pub(crate) fn stand_at(&mut self, x: &Unknowns) {
        self.damping = 0.0;
        self.foreseen_mpa.copy_from_slice(x.pressures_mpa);
    }
}
