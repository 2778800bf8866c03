//! Newton's method with a line search down the energy.

use faer::dyn_stack::MemBuffer;
use glam::{DMat3, DVec3};

use crate::body::SoftBody;
use crate::contact::{Contact, RigidBody};
use crate::krylov::{ConjugateGradients, Outcome};
use crate::material::{Memory, Relaxation};
use crate::system::Factors;

/// Trial steps of a line search before the direction is given up.
const MAX_TRIALS: u32 = 20;

/// Part of the decrease promised by the slope that a trial step must reach (Armijo).
const SUFFICIENT_DECREASE: f64 = 1e-4;

/// What contact stiffness is multiplied by where nodes are too deep inside a shape.
const STIFFENING: f64 = 4.0;

/// Steps below this part of their direction are short.
const SHORT: f64 = 0.2;

/// Smallest damping worth having.
const LEAST_DAMPING: f64 = 0.01;

/// A trial whose slope is below this part of that at the start is close enough to the lowest point.
const FLAT: f64 = 0.5;

/// Below this part of the energy, and of the shear modulus times the volume, a change of energy is round-off, and the slope decides.
const ROUND_OFF: f64 = 1e-13;

/// Accuracy of a direction: the part of the right-hand side, in the norm of the preconditioner, that may be left.
const FORCING: f64 = 1e-2;

/// Conjugate gradient iterations that cost less than new factors.
const MAX_STALE_ITERATIONS: u32 = 12;

/// Conjugate gradient iterations with new factors: a few make up for single precision.
const MAX_FRESH_ITERATIONS: u32 = 50;

/// A step to solve: everything that stays fixed while the displacements are sought.
pub(crate) struct Step<'a> {
    pub(crate) relaxation: &'a Relaxation,
    pub(crate) memory: &'a Memory,
    pub(crate) shapes: &'a [RigidBody<'a>],
}

/// Unknowns of a step.
pub(crate) struct Unknowns<'a> {
    pub(crate) displacements_mm: &'a mut Vec<DVec3>,
    pub(crate) pressures_mpa: &'a mut Vec<f64>,
    pub(crate) contacts: &'a mut Vec<Contact>,
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
struct Evaluation {
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
    factors: Factors,
    has_factors: bool,
    /// Extra stiffness, in units of each node's own, that keeps steps within reach.
    damping: f64,
    gradients: ConjugateGradients,
    pressure_scratch: MemBuffer,
    /// Gradient of the energy at each node, N; at bonded nodes the force of what holds them. `[n_nodes]`
    pub(crate) gradient_n: Vec<DVec3>,
    direction_mm: Vec<DVec3>,
    unbalanced_n: Vec<DVec3>,
    start_mm: Vec<DVec3>,
    volume_changes: Vec<f64>,
    /// Constant stresses of the step. `[n_tets]`, or empty for an elastic material.
    offsets: Vec<DMat3>,
}

impl Workspace {
    pub(crate) fn buffers(&mut self, body: &SoftBody) -> &mut Buffers {
        self.0.get_or_insert_with(|| {
            let n_nodes = body.mesh().nodes_mm.len();
            Box::new(Buffers {
                factors: body.system.factors(),
                has_factors: false,
                damping: 0.0,
                gradients: ConjugateGradients::new(&body.system),
                pressure_scratch: body.compressibility.scratch(),
                gradient_n: vec![DVec3::ZERO; n_nodes],
                direction_mm: vec![DVec3::ZERO; n_nodes],
                unbalanced_n: vec![DVec3::ZERO; n_nodes],
                start_mm: vec![DVec3::ZERO; n_nodes],
                volume_changes: vec![0.0; n_nodes],
                offsets: Vec::new(),
            })
        })
    }
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
        self.prepare(body, step);
        self.damping = 0.0;
        let settings = &body.settings;
        let mut now = self.evaluate(body, step, x).ok_or(Failure::Inverted)?;
        let mut has_failed = false;
        for _ in 0..=settings.max_iterations {
            let residual = now.unbalanced_n / now.load_n.max(body.negligible_load_n());
            if residual <= settings.tolerance {
                if !push_out(body, x.contacts) {
                    return Ok(Equilibrium {
                        residual,
                        smallest_volume_ratio: now.smallest_volume_ratio,
                    });
                }
                now = self.evaluate(body, step, x).ok_or(Failure::Inverted)?;
            }
            *iterations += 1;
            self.find_direction(body, step, x)?;
            match self.search(body, step, x, &now) {
                Ok((next, length)) => {
                    now = next;
                    has_failed = false;
                    self.adapt_damping(length);
                }
                // A direction that leads nowhere: once more with new factors and a short leash.
                Err(_) if !has_failed => {
                    has_failed = true;
                    self.has_factors = false;
                    self.adapt_damping(0.0);
                    now = self.evaluate(body, step, x).ok_or(Failure::Inverted)?;
                }
                Err(Failure::Inverted) => return Err(Failure::Inverted),
                Err(_) => break,
            }
        }
        Err(Failure::NotConverged {
            residual: now.unbalanced_n / now.load_n.max(body.negligible_load_n()),
        })
    }

    /// Energy of a start, for comparing starts; none if it is inside out.
    pub(crate) fn energy(&mut self, body: &SoftBody, step: &Step, x: &mut Unknowns) -> Option<f64> {
        self.prepare(body, step);
        self.evaluate(body, step, x).map(|evaluation| evaluation.energy)
    }

    fn prepare(&mut self, body: &SoftBody, step: &Step) {
        self.offsets.clear();
        if !body.material().prony.is_empty() {
            self.offsets
                .extend((0..body.elements.len()).map(|tet| step.relaxation.offset(step.memory, tet)));
        }
    }

    fn offset(&self, tet: usize) -> DMat3 {
        self.offsets.get(tet).copied().unwrap_or(DMat3::ZERO)
    }

    /// Pressures, contact, energy and its gradient; none if a tetrahedron is inside out.
    fn evaluate(&mut self, body: &SoftBody, step: &Step, x: &mut Unknowns) -> Option<Evaluation> {
        let mut evaluation = Evaluation {
            smallest_volume_ratio: f64::INFINITY,
            ..Evaluation::default()
        };
        x.pressures_mpa.fill(0.0);
        for element in &body.elements {
            let volume_ratio = element.deformation(x.displacements_mm).volume_ratio;
            evaluation.smallest_volume_ratio = evaluation.smallest_volume_ratio.min(volume_ratio);
            let share = 0.25 * element.volume_mm3 * (volume_ratio - 1.0);
            for &node in &element.nodes {
                x.pressures_mpa[node as usize] -= share;
            }
        }
        let smallest = evaluation.smallest_volume_ratio;
        if smallest.is_nan() || smallest <= 0.0 {
            return None;
        }
        self.volume_changes.copy_from_slice(x.pressures_mpa);
        body.compressibility
            .solve(x.pressures_mpa, &mut self.pressure_scratch);
        let volumetric: f64 = self
            .volume_changes
            .iter()
            .zip(x.pressures_mpa.iter())
            .map(|(g, p)| g * p)
            .sum();
        evaluation.energy = 0.5 * volumetric;

        self.gradient_n.fill(DVec3::ZERO);
        let law = &body.material().isochoric;
        for (tet, element) in body.elements.iter().enumerate() {
            let deformation = element.deformation(x.displacements_mm);
            let right_cauchy_green = deformation.isochoric_right_cauchy_green();
            let response = step
                .relaxation
                .response_mpa(law, &self.offset(tet), &right_cauchy_green);
            evaluation.energy += element.volume_mm3 * response.energy;
            let forces = element.forces(&deformation, &response, element.mean(x.pressures_mpa));
            for (&node, force) in element.nodes.iter().zip(forces) {
                self.gradient_n[node as usize] += force;
            }
        }
        for (shape, contact) in step.shapes.iter().zip(x.contacts.iter_mut()) {
            for (boundary, touch) in body.boundary.iter().zip(&mut contact.touches) {
                let node = boundary.node as usize;
                let at_mm = body.mesh().nodes_mm[node] + x.displacements_mm[node];
                evaluation.energy += shape.touch(touch, at_mm, boundary.stiffness * contact.stiffening);
                self.gradient_n[node] -= touch.normal * touch.force_n;
                evaluation.load_n += touch.force_n;
            }
        }
        let mut unbalanced = 0.0;
        for (node, gradient) in self.gradient_n.iter().enumerate() {
            if body.system.displacement(node).is_some() {
                unbalanced += gradient.length_squared();
            } else {
                evaluation.load_n = evaluation.load_n.max(gradient.length());
            }
        }
        evaluation.unbalanced_n = unbalanced.sqrt();
        evaluation.energy.is_finite().then_some(evaluation)
    }

    /// Newton's direction at the unknowns; where the energy is not convex, that of a stiffened, convex one.
    fn find_direction(&mut self, body: &SoftBody, step: &Step, x: &Unknowns) -> Result<(), Failure> {
        for (unbalanced, gradient) in self.unbalanced_n.iter_mut().zip(&self.gradient_n) {
            *unbalanced = -*gradient;
        }
        let mut is_fresh = false;
        if self.has_factors {
            self.assemble(body, step, x, true, self.damping);
        } else {
            self.factorise(body, step, x)?;
            is_fresh = true;
        }
        let mut target = None;
        body.system
            .put_forces(&self.unbalanced_n, &mut self.gradients.residual);
        self.gradients.solution.fill(0.0);
        loop {
            let limit = if is_fresh {
                MAX_FRESH_ITERATIONS
            } else {
                MAX_STALE_ITERATIONS
            };
            let (factors, scratch) = (&mut self.factors, &mut self.pressure_scratch);
            let outcome = self
                .gradients
                .iterate(body, factors, scratch, FORCING, &mut target, limit);
            if outcome == Outcome::Converged || is_fresh {
                break;
            }
            // The factors are too old: start afresh, as the tangent may have been stiffened as well.
            self.factorise(body, step, x)?;
            is_fresh = true;
            target = None;
            body.system
                .put_forces(&self.unbalanced_n, &mut self.gradients.residual);
            self.gradients.solution.fill(0.0);
        }
        body.system
            .take_displacements(&self.gradients.solution, &mut self.direction_mm);
        Ok(())
    }

    /// Factorises the tangent: the true one if it is convex, else without the curvature of the shapes, else ever stiffer.
    fn factorise(&mut self, body: &SoftBody, step: &Step, x: &Unknowns) -> Result<(), Failure> {
        self.has_factors = false;
        for (with_curvature, extra) in [
            (true, 0.0),
            (false, 0.0),
            (false, 0.02),
            (false, 0.1),
            (false, 0.5),
            (false, 2.0),
            (false, 10.0),
        ] {
            let damping = self.damping + extra;
            self.assemble(body, step, x, with_curvature, damping);
            if body
                .system
                .factorise(&mut self.factors)
                .map_err(|_| Failure::Singular)?
            {
                self.has_factors = true;
                self.damping = damping;
                return Ok(());
            }
        }
        Err(Failure::Singular)
    }

    /// Short steps tell that the tangent is a poor guide: trust it less (Levenberg, 1944), and more again after whole ones.
    fn adapt_damping(&mut self, length: f64) {
        if length < SHORT {
            self.damping = (4.0 * self.damping).max(LEAST_DAMPING);
        } else if length == 1.0 {
            self.damping *= 0.25;
        }
        if self.damping < LEAST_DAMPING {
            self.damping = 0.0;
        }
    }

    fn assemble(&mut self, body: &SoftBody, step: &Step, x: &Unknowns, with_curvature: bool, damping: f64) {
        let law = &body.material().isochoric;
        body.system.clear(&mut self.factors);
        for (tet, element) in body.elements.iter().enumerate() {
            let deformation = element.deformation(x.displacements_mm);
            let right_cauchy_green = deformation.isochoric_right_cauchy_green();
            let response = step
                .relaxation
                .response_mpa(law, &self.offset(tet), &right_cauchy_green);
            let tangent = element.tangent(&deformation, &response, element.mean(x.pressures_mpa));
            body.system.add(&mut self.factors, tet, element, &tangent);
        }
        for (shape, contact) in step.shapes.iter().zip(x.contacts.iter()) {
            for (boundary, touch) in body.boundary.iter().zip(&contact.touches) {
                if touch.force_n > 0.0 {
                    let node = boundary.node as usize;
                    let at_mm = body.mesh().nodes_mm[node] + x.displacements_mm[node];
                    let stiffness = shape.stiffness(
                        touch,
                        at_mm,
                        boundary.stiffness * contact.stiffening,
                        with_curvature,
                    );
                    body.system.add_to_node(&mut self.factors, node, &stiffness);
                }
            }
        }
        if damping > 0.0 {
            for (node, stiffness) in body.node_stiffness.iter().enumerate() {
                let extra = DMat3::from_diagonal(DVec3::splat(damping * stiffness));
                body.system.add_to_node(&mut self.factors, node, &extra);
            }
        }
    }

    /// Goes along the direction to where the energy is about lowest, at most its whole length. Trials cost little beside a direction.
    fn search(
        &mut self,
        body: &SoftBody,
        step: &Step,
        x: &mut Unknowns,
        start: &Evaluation,
    ) -> Result<(Evaluation, f64), Failure> {
        let slope_at_start = -dot(&self.unbalanced_n, &self.direction_mm);
        let round_off = ROUND_OFF * (start.energy.abs() + body.energy_scale_n_mm());
        self.start_mm.copy_from_slice(x.displacements_mm);
        // The energy falls at `low`, where the best trial is; beyond `high` it rises, or a tetrahedron is inside out.
        let (mut low, mut slope_at_low, mut is_usable) = (0.0, slope_at_start, false);
        let (mut high, mut slope_at_high) = (1.0, None);
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
                        && (slope.abs() <= FLAT * slope_at_start.abs() || slope < 0.0 && length == 1.0) =>
                {
                    return Ok((trial, length));
                }
                Some(_) if falls && slope < 0.0 => (low, slope_at_low, is_usable) = (length, slope, true),
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

/// Stiffens the contact with shapes that a node is too deep inside of; true if there are any.
fn push_out(body: &SoftBody, contacts: &mut [Contact]) -> bool {
    let mut any = false;
    for contact in contacts {
        if contact
            .touches
            .iter()
            .any(|touch| touch.gap_mm < -body.settings.penetration_mm)
        {
            contact.stiffening *= STIFFENING;
            any = true;
        }
    }
    any
}

fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}
