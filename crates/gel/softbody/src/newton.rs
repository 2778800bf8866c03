//! Newton's method with a line search down the energy.

mod derivatives;

use std::time::Instant;

use glam::{DMat3, DVec3, Mat3, Vec3};

use crate::body::SoftBody;
use crate::contact::{Contact, ContactPoint, RigidBody};
use crate::element::{CoarseSink, CoarseTangent, Forces, Response, Volumes};
use crate::linear::block::{Block, Vector};
use crate::linear::coarse::{Factors, Tangent};
use crate::linear::cycle::{Cycle, TwoLevel};
use crate::linear::direct::DirectSystem;
use crate::linear::krylov::{ConjugateGradients, Outcome};
use crate::linear::matrix::Matrix;
use crate::parallel::join_halves;
use crate::relaxation::Relaxation;
use crate::sensitivity::{Passed, Sensitivity};
use crate::state::Cost;
use crate::wide::LANES;

pub use derivatives::DerivativeErrors;

/// Trial steps of a line search before the direction is given up.
const MAX_TRIALS: u32 = 20;

/// Part of the decrease promised by the slope that a trial step must reach (Armijo).
const SUFFICIENT_DECREASE: f64 = 1e-4;

/// Steps below this part of their direction are short.
const SHORT: f64 = 0.2;

/// Longest step, in directions: where a node slips off an edge, the energy bends down and a direction falls short.
const MAX_STRETCH: f64 = 16.0;

/// Smallest damping worth having.
const LEAST_DAMPING: f64 = 0.01;

/// A trial whose slope is below this part of that at the start is close enough to the lowest point.
const FLAT: f64 = 0.5;

/// Below this part of the energy, and of the shear modulus times the volume, a change of energy is round-off, and the slope decides.
const ROUND_OFF: f64 = 1e-13;

/// Accuracy of a direction: iterations end when one adds less than the square of this to the energy that a direction wins.
const FORCING: f64 = 0.3;

/// Part of the tolerance below which the start of a step needs no improvement.
const UNTOUCHED: f64 = 0.1;

/// A step that leaves more than this part of the unbalanced forces calls for a new matrix.
const SLOW: f64 = 0.3;

/// Conjugate gradient iterations that cost less than new factors.
const MAX_STALE_ITERATIONS: u32 = 12;

/// Conjugate gradient iterations with new factors: a few make up for single precision.
const MAX_FRESH_ITERATIONS: u32 = 50;

/// A step to solve: everything that stays fixed while the displacements are sought.
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

/// Unknowns before a step.
#[derive(Default)]
pub(crate) struct Beginning {
    pub(crate) displacements_mm: Vec<DVec3>,
    pub(crate) pressures_mpa: Vec<f64>,
    pub(crate) contacts: Vec<Contact>,
    pub(crate) sensitivities: Vec<Sensitivity>,
}

/// Why a step failed.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Failure {
    NotConverged { residual: f64 },
    Inverted,
    Singular,
}

/// How a step ended well.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Equilibrium {
    pub(crate) residual: f64,
    pub(crate) smallest_volume_ratio: f64,
}

/// Energy and its slope at a set of displacements.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Evaluation {
    energy: f64,
    smallest_volume_ratio: f64,
    /// 2-norm of the gradient at free nodes, N.
    unbalanced_n: f64,
    /// Sum of the sizes of all forces from outside, N.
    load_n: f64,
}

/// Memory that a press works in. Not part of its state: a clone starts without.
#[derive(Default)]
pub(crate) struct Workspace(Option<Box<Buffers>>);

impl Clone for Workspace {
    fn clone(&self) -> Self {
        Self::default()
    }
}

pub(crate) struct Buffers {
    matrix: Matrix,
    /// Whether it led well when it was used last: then it is good enough for more, in this step and the next.
    pub(crate) has_matrix: bool,
    /// None before the first, or after a direction that led nowhere.
    factors: Option<Factors>,
    /// Where they are made; memory of presses that make some of their own.
    tangent: Option<Box<Tangent>>,
    cycle: Cycle,
    gradients: ConjugateGradients,
    /// `[n_slots]`
    coarse_tangents: Vec<CoarseTangent>,
    forces: Forces,
    volumes: Volumes,
    /// Pressures of each slot's corners, MPa.
    corners: Vec<[f64; 4]>,
    /// Extra stiffness, in units of each node's own, that keeps steps within reach.
    damping: f64,
    /// Gradient of the energy at each node, N; at bonded nodes the force of what holds them. `[n_nodes]`
    pub(crate) gradient_n: Vec<DVec3>,
    /// `[n_free]`
    pub(crate) direction_mm: Vec<DVec3>,
    /// Pressures that the tangent is taken at, MPa: an unknown of their own, as in a mixed formulation, that the linear systems take to
    /// equilibrium; those that the volumes have on the way there would bend the tangent.
    foreseen_mpa: Vec<f64>,
    start_mm: Vec<DVec3>,
    start_mpa: Vec<f64>,
    /// Where the step began.
    pub(crate) old: Beginning,
    /// Whether equilibria from which contacts were carried on are kept, and those of the last step.
    pub(crate) keeps_passed: bool,
    pub(crate) passed: Vec<Passed>,
    /// What has been spent since this was last taken.
    pub(crate) cost: Cost,
}

impl Workspace {
    pub(crate) fn buffers(&mut self, body: &SoftBody) -> &mut Buffers {
        self.0.get_or_insert_with(|| {
            let n_nodes = body.mesh().nodes_mm.len();
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
                volumes: Volumes::default(),
                corners: Vec::new(),
                damping: 0.0,
                gradient_n: vec![DVec3::ZERO; n_nodes],
                direction_mm: vec![DVec3::ZERO; n_free],
                foreseen_mpa: vec![0.0; body.volume_stiffness.len()],
                start_mm: vec![DVec3::ZERO; n_nodes],
                start_mpa: vec![0.0; body.volume_stiffness.len()],
                old: Beginning::default(),
                keeps_passed: false,
                passed: Vec::new(),
                cost: Cost::default(),
            })
        })
    }
}

/// Factors of a body at rest, which all its presses start with.
pub(crate) fn rest_factors(body: &SoftBody) -> Option<Factors> {
    let mut state = body.rest();
    let still = Relaxation::new(&body.material().prony, 0.0);
    let step = Step {
        response: Response {
            material: body.material(),
            relaxation: &still,
            memory: &state.memory,
        },
        shapes: &[],
    };
    let x = Unknowns {
        displacements_mm: &mut state.displacements_mm,
        pressures_mpa: &mut state.pressures_mpa,
        contacts: &mut state.contacts,
    };
    let buffers = state.workspace.buffers(body);
    buffers.factorise(body, &step, &x).ok()?;
    buffers.factors.take()
}

impl Buffers {
    /// Finds the equilibrium of a step, starting from the unknowns given. `iterations` counts up.
    pub(crate) fn solve(
        &mut self,
        body: &SoftBody,
        step: &Step,
        x: &mut Unknowns,
        iterations: &mut u32,
    ) -> Result<Equilibrium, Failure> {
        self.damping = 0.0;
        self.passed.clear();
        let settings = &body.settings;
        let mut now = self.evaluate(body, step, x).ok_or(Failure::Inverted)?;
        let mut has_failed = false;
        for iteration in 0..=settings.max_iterations {
            let residual = now.unbalanced_n / now.load_n.max(body.least_load_n());
            // A start is taken for the answer only if it is much better than it has to be: errors must not pile up from step to step.
            let goal = if iteration == 0 { UNTOUCHED } else { 1.0 } * settings.tolerance;
            if residual <= goal {
                // Some materials pass through inverted tetrahedra, but none may end there.
                if now.smallest_volume_ratio <= 0.0 {
                    return Err(Failure::Inverted);
                }
                let passed = self.keeps_passed.then(|| Passed {
                    displacements_mm: x.displacements_mm.clone(),
                    pressures_mpa: x.pressures_mpa.clone(),
                    contacts: x.contacts.clone(),
                });
                let moved_n = follow_friction(x.contacts);
                let has_pushed = push_out(body, x.contacts);
                if !has_pushed && moved_n <= settings.tolerance * now.load_n {
                    self.foreseen_mpa.copy_from_slice(x.pressures_mpa);
                    return Ok(Equilibrium {
                        residual,
                        smallest_volume_ratio: now.smallest_volume_ratio,
                    });
                }
                self.passed.extend(passed);
                now = self.evaluate(body, step, x).ok_or(Failure::Inverted)?;
                continue;
            }
            *iterations += 1;
            self.find_direction(body, step, x, FORCING)?;
            match self.search(body, step, x, &now) {
                Ok((next, length)) => {
                    self.has_matrix = length == 1.0 && next.unbalanced_n <= SLOW * now.unbalanced_n;
                    now = next;
                    let changes = self.start_mpa.iter().zip(&self.gradients.solution_mpa);
                    for (foreseen, (start, change)) in self.foreseen_mpa.iter_mut().zip(changes) {
                        *foreseen += length * (start - f64::from(*change) - *foreseen);
                    }
                    has_failed = false;
                    self.adapt_damping(length);
                    if follow_friction(x.contacts) > 0.0 {
                        now = self.evaluate(body, step, x).ok_or(Failure::Inverted)?;
                    }
                }
                // A direction that leads nowhere: once more with new factors and a short leash.
                Err(_) if !has_failed => {
                    has_failed = true;
                    self.has_matrix = false;
                    self.factors = None;
                    self.adapt_damping(0.0);
                    now = self.evaluate(body, step, x).ok_or(Failure::Inverted)?;
                }
                Err(Failure::Inverted) => return Err(Failure::Inverted),
                Err(_) => break,
            }
        }
        self.has_matrix = false;
        Err(Failure::NotConverged {
            residual: now.unbalanced_n / now.load_n.max(body.least_load_n()),
        })
    }

    /// Takes the true tangent at the unknowns, which are at equilibrium, for the directions to come.
    pub(crate) fn stand_at(&mut self, x: &Unknowns) {
        self.damping = 0.0;
        self.foreseen_mpa.copy_from_slice(x.pressures_mpa);
    }

    /// Whether no tetrahedron is inside out, or the material bears it.
    pub(crate) fn is_valid(&mut self, body: &SoftBody, x: &mut Unknowns) -> bool {
        is_admissible(body, body.elements.volumes(x.displacements_mm, &mut self.volumes))
    }

    /// Pressures, contact, energy and its gradient; none if a tetrahedron is inside out and the material does not bear it.
    pub(crate) fn evaluate(&mut self, body: &SoftBody, step: &Step, x: &mut Unknowns) -> Option<Evaluation> {
        let started = Instant::now();
        let mut evaluation = Evaluation {
            smallest_volume_ratio: body.elements.volumes(x.displacements_mm, &mut self.volumes),
            ..Evaluation::default()
        };
        if !is_admissible(body, evaluation.smallest_volume_ratio) {
            return None;
        }
        let changes = self.volumes.changes_mm3.as_flattened();
        let ranges = body.volume_starts.windows(2);
        for ((pressure, stiffness), range) in
            x.pressures_mpa.iter_mut().zip(&body.volume_stiffness).zip(ranges)
        {
            let sources = &body.volume_sources[range[0] as usize..range[1] as usize];
            let change: f64 = sources.iter().map(|&source| changes[source as usize]).sum();
            *pressure = -stiffness * change;
            evaluation.energy += 0.5 * stiffness * change * change;
        }

        body.corner_pressures(x.pressures_mpa, &mut self.corners);
        body.elements
            .forces(step.response, x.displacements_mm, &self.corners, &mut self.forces);
        evaluation.energy += self.forces.energies.iter().sum::<f64>();
        let forces = self.forces.forces_n.as_flattened();
        let half = self.gradient_n.len() / 2;
        let (first, second) = self.gradient_n.split_at_mut(half);
        let gather = |first: usize, gradients: &mut [DVec3]| {
            let ranges = body.force_starts[first..].windows(2);
            for (gradient, range) in gradients.iter_mut().zip(ranges) {
                let sources = &body.force_sources[range[0] as usize..range[1] as usize];
                *gradient = sources.iter().map(|&source| forces[source as usize]).sum();
            }
        };
        join_halves(|| gather(0, first), || gather(half, second));
        self.cost.forces_s += started.elapsed().as_secs_f64();

        let started = Instant::now();
        for (shape, contact) in step.shapes.iter().zip(x.contacts.iter_mut()) {
            for (point, touch) in contact.each_mut(&body.boundary) {
                let at_mm = body.point_mm(point, x.displacements_mm);
                evaluation.energy += shape.touch(touch, point, at_mm);
                if touch.force_n > 0.0 {
                    for (node, part) in point.parts() {
                        self.gradient_n[node as usize] -= touch.normal * (part * touch.force_n);
                    }
                    evaluation.load_n += touch.force_n;
                }
            }
            if let Some(friction) = &mut contact.friction {
                let nodes = body.boundary_mm(x.displacements_mm);
                evaluation.energy += friction.pull(shape, nodes, |point, force_n| {
                    for (node, part) in point.parts() {
                        self.gradient_n[node as usize] -= force_n * part;
                    }
                });
            }
        }
        self.cost.contact_s += started.elapsed().as_secs_f64();
        for &(node, force) in &body.loads_n {
            evaluation.energy -= force.dot(x.displacements_mm[node as usize]);
            self.gradient_n[node as usize] -= force;
            evaluation.load_n += force.length();
        }
        let (free, bonded) = self.gradient_n.split_at(body.pattern.halves.free);
        let largest = bonded.iter().map(|force| force.length()).fold(0.0, f64::max);
        evaluation.load_n = evaluation.load_n.max(largest);
        evaluation.unbalanced_n = free
            .iter()
            .map(|force| force.length_squared())
            .sum::<f64>()
            .sqrt();
        evaluation.energy.is_finite().then_some(evaluation)
    }

    /// Newton's direction at the unknowns; where the energy is not convex, that of a stiffened, convex one.
    pub(crate) fn find_direction(
        &mut self,
        body: &SoftBody,
        step: &Step,
        x: &Unknowns,
        forcing: f64,
    ) -> Result<(), Failure> {
        match self.try_direction(body, step, x, forcing) {
            // Far from equilibrium, pressures foreseen can bend the tangent more than stiffening makes up for.
            Err(Failure::Singular) if self.foreseen_mpa.iter().any(|mpa| *mpa != 0.0) => {
                self.foreseen_mpa.fill(0.0);
                self.has_matrix = false;
                self.try_direction(body, step, x, forcing)
            }
            result => result,
        }
    }

    fn try_direction(
        &mut self,
        body: &SoftBody,
        step: &Step,
        x: &Unknowns,
        forcing: f64,
    ) -> Result<(), Failure> {
        let started = Instant::now();
        if !self.has_matrix {
            self.assemble(body, step, x);
        }
        self.add_contact(body, step, x);
        self.cost.assembly_s += started.elapsed().as_secs_f64();
        if let Some(direct) = &body.direct {
            self.has_matrix = false;
            if self.find_direction_directly(body, direct) {
                return Ok(());
            }
        }
        let mut is_fresh = false;
        if self.factors.is_none() {
            self.factorise(body, step, x)?;
        }
        loop {
            self.take_residual();
            let Some(factors) = &mut self.factors else {
                break;
            };
            let mut system = TwoLevel {
                pattern: &body.pattern,
                matrix: &self.matrix,
                coarse: &body.coarse,
                factors,
                ends: &body.ends,
                cycle: &mut self.cycle,
            };
            let max_iterations = if is_fresh {
                MAX_FRESH_ITERATIONS
            } else {
                MAX_STALE_ITERATIONS
            };
            let started = Instant::now();
            let (outcome, n_iterations) = self.gradients.solve(&mut system, forcing, max_iterations);
            self.cost.linear_solve_s += started.elapsed().as_secs_f64();
            self.cost.linear_iterations += n_iterations;
            if outcome == Outcome::Converged || is_fresh {
                break;
            }
            self.factorise(body, step, x)?;
            is_fresh = true;
        }
        self.take_direction();
        Ok(())
    }

    /// The same, by factors of the whole system; false where it is not convex.
    fn find_direction_directly(&mut self, body: &SoftBody, direct: &DirectSystem) -> bool {
        let started = Instant::now();
        self.take_residual();
        let matrix = &self.matrix;
        let is_found = self
            .gradients
            .take(&body.pattern, |forces, displacements, volumes| {
                direct.solve(matrix, forces, displacements, volumes)
            });
        self.take_direction();
        self.cost.factorisation_s += started.elapsed().as_secs_f64();
        self.cost.factorisations += 1;
        is_found
    }

    fn take_residual(&mut self) {
        for (residual, gradient) in self.gradients.vectors.residual.iter_mut().zip(&self.gradient_n) {
            *residual = Vector::from_dvec3(-*gradient);
        }
    }

    fn take_direction(&mut self) {
        for (direction, solution) in self.direction_mm.iter_mut().zip(&self.gradients.vectors.solution) {
            *direction = solution.to_dvec3();
        }
    }

    /// Factorises the coarse tangent: the true one if it is convex, else ever stiffer.
    fn factorise(&mut self, body: &SoftBody, step: &Step, x: &Unknowns) -> Result<(), Failure> {
        let started = Instant::now();
        self.factors = None;
        self.assemble_coarse(body, step, x);
        let tangent = self
            .tangent
            .get_or_insert_with(|| Box::new(body.coarse.tangent()));
        for extra in [0.0, 0.02, 0.1, 0.5, 2.0, 10.0] {
            let slots = body.elements.slots.iter();
            let of_elements = slots.map(|&slot| &self.coarse_tangents[slot as usize]);
            body.coarse.fill(tangent, of_elements);
            for_each_touch(body, step, x, &mut |point, stiffness| {
                let ends = point.parts().flat_map(|(node, part)| {
                    let ends = body.ends[node as usize];
                    ends.map(|end| (end, 0.5 * part as f32))
                });
                body.coarse.add_at(tangent, ends, &stiffness.as_mat3());
            });
            let damping = self.damping + extra;
            if damping > 0.0 {
                for (ends, stiffness) in body.ends.iter().zip(&body.node_stiffness) {
                    if ends[0] == ends[1] {
                        let own = Mat3::from_diagonal(Vec3::splat((damping * stiffness) as f32));
                        body.coarse.add_to_node(tangent, ends[0], &own);
                    }
                }
            }
            self.factors = body.coarse.factorise(tangent).map_err(|_| Failure::Singular)?;
            if self.factors.is_some() {
                self.cost.factorisation_s += started.elapsed().as_secs_f64();
                self.cost.factorisations += 1;
                return Ok(());
            }
        }
        Err(Failure::Singular)
    }

    fn assemble_coarse(&mut self, body: &SoftBody, step: &Step, x: &Unknowns) {
        body.corner_pressures(&self.foreseen_mpa, &mut self.corners);
        let (elements, u) = (&body.elements, &*x.displacements_mm);
        let [first, second] = elements.halves.map(|pack| pack * LANES);
        let (tangents, between) = self.coarse_tangents.split_at_mut(second);
        let halves = tangents.split_at_mut(first);
        let sink = |first, tangents| CoarseSink { first, tangents };
        elements.tangents(
            step.response,
            u,
            &self.corners,
            [sink(0, halves.0), sink(first, halves.1)],
        );
        elements.tangents_between(step.response, u, &self.corners, sink(second, between));
    }

    /// Short steps tell that the tangent is a poor guide: trust it less (Levenberg, 1944), and more again after whole ones.
    fn adapt_damping(&mut self, length: f64) {
        if length < SHORT {
            self.damping = (4.0 * self.damping).max(LEAST_DAMPING);
        } else if length >= 1.0 {
            self.damping *= 0.25;
        }
        if self.damping < LEAST_DAMPING {
            self.damping = 0.0;
        }
    }

    fn assemble(&mut self, body: &SoftBody, step: &Step, x: &Unknowns) {
        body.corner_pressures(&self.foreseen_mpa, &mut self.corners);
        let (elements, u) = (&body.elements, &*x.displacements_mm);
        elements.tangents(step.response, u, &self.corners, self.matrix.halves(&body.pattern));
        elements.tangents_between(
            step.response,
            u,
            &self.corners,
            self.matrix.between(&body.pattern),
        );
        self.matrix.scale_slopes(&body.pattern);
    }

    /// Completes the matrix with what contact and damping add.
    fn add_contact(&mut self, body: &SoftBody, step: &Step, x: &Unknowns) {
        for (extra, stiffness) in self.matrix.extra.iter_mut().zip(&body.node_stiffness) {
            *extra = Block::diagonal((self.damping * stiffness) as f32);
        }
        self.matrix.take_back();
        for_each_touch(body, step, x, &mut |point, stiffness| {
            self.matrix
                .add_at(&body.pattern, point.parts(), &stiffness.as_mat3());
        });
        self.matrix.complete(&body.pattern);
    }

    /// Goes along the direction to where the energy is about lowest, at most its whole length. Trials cost little beside a direction.
    fn search(
        &mut self,
        body: &SoftBody,
        step: &Step,
        x: &mut Unknowns,
        start: &Evaluation,
    ) -> Result<(Evaluation, f64), Failure> {
        let slope_at_start = dot(&self.gradient_n, &self.direction_mm);
        let round_off = ROUND_OFF * (start.energy.abs() + body.energy_scale_n_mm());
        self.start_mm.copy_from_slice(x.displacements_mm);
        self.start_mpa.copy_from_slice(x.pressures_mpa);
        // The energy falls at `low`, where the best trial is; beyond `high` it rises, or a tetrahedron is inside out.
        let (mut low, mut slope_at_low, mut is_usable) = (0.0, slope_at_start, false);
        let (mut high, mut slope_at_high) = (f64::INFINITY, None);
        let mut length = 1.0;
        for _ in 0..MAX_TRIALS {
            let trial = self.try_length(body, step, x, length);
            let slope = dot(&self.gradient_n, &self.direction_mm);
            let falls = trial.is_some_and(|trial| {
                let change = trial.energy - start.energy;
                change <= SUFFICIENT_DECREASE * length * slope_at_start
                    || (change.abs() <= round_off && slope.abs() <= 0.9 * slope_at_start.abs())
            });
            match trial {
                Some(trial)
                    if falls
                        && (slope.abs() <= FLAT * slope_at_start.abs()
                            || slope < 0.0 && length >= MAX_STRETCH) =>
                {
                    return Ok((trial, length));
                }
                Some(_) if falls && slope < 0.0 => {
                    (low, slope_at_low, is_usable) = (length, slope, true);
                    if high.is_infinite() {
                        length *= 2.0;
                        continue;
                    }
                }
                Some(_) => (high, slope_at_high) = (length, (slope > 0.0).then_some(slope)),
                None => (high, slope_at_high) = (length, None),
            }
            if is_usable && high - low < 0.1 * high {
                break;
            }
            // Where a line through both slopes is zero, but well inside.
            let part = slope_at_high.map_or(0.5, |high| slope_at_low / (slope_at_low - high));
            length = low + part.clamp(0.1, 0.9) * (high - low);
        }
        let trial = self.try_length(body, step, x, low);
        match trial {
            Some(trial) if is_usable => Ok((trial, low)),
            _ if slope_at_high.is_none() => Err(Failure::Inverted),
            _ => Err(Failure::NotConverged { residual: f64::NAN }),
        }
    }

    fn try_length(
        &mut self,
        body: &SoftBody,
        step: &Step,
        x: &mut Unknowns,
        length: f64,
    ) -> Option<Evaluation> {
        for ((u, start), direction) in x
            .displacements_mm
            .iter_mut()
            .zip(&self.start_mm)
            .zip(&self.direction_mm)
        {
            *u = *start + *direction * length;
        }
        self.evaluate(body, step, x)
    }
}

/// Whether the energy is defined at this smallest volume ratio.
fn is_admissible(body: &SoftBody, smallest_volume_ratio: f64) -> bool {
    smallest_volume_ratio > 0.0 || (body.material().bears_inversion() && !smallest_volume_ratio.is_nan())
}

fn for_each_touch(body: &SoftBody, step: &Step, x: &Unknowns, add: &mut dyn FnMut(&ContactPoint, &DMat3)) {
    for (shape, contact) in step.shapes.iter().zip(x.contacts.iter()) {
        for (point, touch) in contact.each(&body.boundary) {
            if touch.force_n > 0.0 {
                let at_mm = body.point_mm(point, x.displacements_mm);
                add(point, &shape.stiffness(touch, point, at_mm));
            }
        }
        let Some(friction) = &contact.friction else {
            continue;
        };
        for (index, (point, at_mm)) in body.boundary_mm(x.displacements_mm).enumerate() {
            if let Some(stiffness) = friction.stiffness(index, shape, at_mm, point.stiffness) {
                add(point, &stiffness);
            }
        }
    }
}

/// Lets friction follow the normal forces; returns by how much its limits change altogether, N.
fn follow_friction(contacts: &mut [Contact]) -> f64 {
    let frictions = contacts
        .iter_mut()
        .filter_map(|contact| Some((contact.friction.as_mut()?, &contact.touches)));
    frictions
        .map(|(friction, touches)| friction.follow(touches))
        .sum()
}

/// Carries the forces of those shapes over in which a point is too deep. True if there are any.
fn push_out(body: &SoftBody, contacts: &mut [Contact]) -> bool {
    let mut any = false;
    for contact in contacts {
        any |= contact.push_out(body.settings.penetration_mm);
    }
    any
}

fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}
