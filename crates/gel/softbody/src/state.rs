//! The state of a soft body.

use std::time::Duration;

use glam::DVec3;
use twintac_shape::Pose;

use crate::body::SoftBody;
use crate::contact::Contact;
use crate::newton::{Beginning, Workspace};
use crate::relaxation::History;
use crate::sensitivity::{Direction, Sensitivity};
use crate::{SoftBodyError, SolverSettings};

/// Largest ratio of a motion to the previous one for which displacements are extrapolated.
const MAX_EXTRAPOLATION: f64 = 2.0;

/// Fraction of a travel beside the last motion above which it is in a new direction.
const ASIDE: f64 = 0.3;

/// The state of a soft body: everything that a press changes. Made by [`SoftBody::rest`].
#[derive(Clone)]
pub struct State {
    pub(crate) displacements_mm: Vec<DVec3>,
    pub(crate) pressures_mpa: Vec<f64>,
    pub(crate) history: History,
    /// Contacts of the indenter's parts, followed by those of the obstacles.
    pub(crate) contacts: Vec<Contact>,
    pub(crate) gel_from_indenter: Option<Pose>,
    /// Last accepted motion, from which the next one is extrapolated.
    pub(crate) last: Option<Motion>,
    /// Slope of the force over the indenter's travel in the last press with a force, N/mm.
    pub(crate) stiffness_n_per_mm: Option<f64>,
    /// Derivatives of all of the above along each requested direction.
    pub(crate) sensitivities: Vec<Sensitivity>,
    /// Time after which a step ends, whether it has converged or not.
    pub(crate) deadline: Option<Duration>,
    /// The step that a deadline has ended, if it is to be continued.
    pub(crate) unfinished: Option<Unfinished>,
    /// Time that has passed and that no step covers yet, s.
    pub(crate) uncovered_s: f64,
    pub(crate) workspace: Workspace,
}

/// A part of a motion that a deadline has ended before the forces were nearly balanced.
#[derive(Clone)]
pub(crate) struct Unfinished {
    pub(crate) from: Pose,
    pub(crate) to: Pose,
    pub(crate) time_step_s: f64,
    pub(crate) iterations: u32,
    /// The pose and the unknowns before it.
    pub(crate) pose_before: Option<Pose>,
    pub(crate) beginning: Beginning,
}

/// A motion of the indenter, and the displacements that followed.
#[derive(Clone, Default)]
pub(crate) struct Motion {
    pub(crate) travel_mm: DVec3,
    pub(crate) displacements_mm: Vec<DVec3>,
}

impl Motion {
    /// Sets the travel, and the displacements as the difference between new and old ones.
    pub(crate) fn set(&mut self, travel_mm: DVec3, new_mm: &[DVec3], old_mm: &[DVec3]) {
        self.travel_mm = travel_mm;
        let ends = new_mm.iter().zip(old_mm);
        self.displacements_mm.clear();
        self.displacements_mm.extend(ends.map(|(new, old)| *new - *old));
    }

    /// Whether the following travel goes on along this motion, forwards or back.
    pub(crate) fn is_followed_by(&self, travel_mm: DVec3) -> bool {
        let aside_mm = travel_mm - self.travel_mm * self.ratio(travel_mm);
        aside_mm.length() < ASIDE * travel_mm.length()
    }

    /// Extrapolates displacements along this motion for the following travel; returns false if they
    /// do not change.
    pub(crate) fn go_on(&self, travel_mm: DVec3, displacements_mm: &mut [DVec3]) -> bool {
        let ratio = self.ratio(travel_mm);
        for (u, change) in displacements_mm.iter_mut().zip(&self.displacements_mm) {
            *u += *change * ratio;
        }
        ratio != 0.0
    }

    /// Ratio of the next motion to this one, negative if it goes back: presses are extrapolated in
    /// depth, not in time.
    fn ratio(&self, travel_mm: DVec3) -> f64 {
        let size = self.travel_mm.length_squared();
        if size > 0.0 {
            (self.travel_mm.dot(travel_mm) / size).clamp(-1.0, MAX_EXTRAPOLATION)
        } else {
            0.0
        }
    }
}

impl State {
    /// How many of its contacts are those of the indenter.
    pub(crate) fn n_indenter_parts(&self, body: &SoftBody) -> usize {
        body.n_indenter_parts(self.contacts.len())
    }

    /// Sets the unknowns to those before a step.
    pub(crate) fn go_back_to(&mut self, beginning: Beginning) {
        self.displacements_mm = beginning.displacements_mm;
        self.pressures_mpa = beginning.pressures_mpa;
        self.contacts = beginning.contacts;
    }

    /// Makes the state what it was before a step that a deadline has ended.
    pub(crate) fn take_back(&mut self, step: Unfinished) {
        self.gel_from_indenter = step.pose_before;
        self.uncovered_s += step.time_step_s;
        self.go_back_to(step.beginning);
    }

    /// Prepares for an indenter with this number of parts. If the number differs, it is another
    /// indenter, and nothing is in contact with it yet.
    pub(crate) fn take_parts(&mut self, body: &SoftBody, n_parts: usize) {
        let n_before = self.n_indenter_parts(body);
        if n_before == n_parts {
            return;
        }
        let n_nodes = body.boundary.nodes.len();
        let untouched = || Contact::new(n_nodes, body.settings.friction);
        let fresh = std::iter::repeat_with(untouched).take(n_parts);
        self.contacts.splice(..n_before, fresh);
        for rates in &mut self.sensitivities {
            rates.take_parts(n_before, n_parts, n_nodes);
        }
    }

    /// The pose of the indenter; `None` before the first step.
    #[must_use]
    pub fn gel_from_indenter(&self) -> Option<Pose> {
        self.gel_from_indenter
    }

    /// From now on, a step of [`SoftBody::advance`] ends within this wall time with the solution
    /// that it has reached: [`crate::Frame::converged`] states whether that is at equilibrium,
    /// [`crate::Frame::residual`] how much force is unbalanced. Where this is much, the next step
    /// finishes it before it moves the indenter on: [`crate::Frame::behind_mm`] states how far the
    /// solution is behind. Each step does at least one iteration, two if it both finishes the last
    /// one and moves on, and no further one that would be late if it took as long as the previous.
    /// A step that needs more iterations than the settings allow is taken back, and done anew
    /// without a deadline. Such results are not reproducible. Presses with a force and presses with
    /// derivatives ignore the deadline.
    pub fn answer_within(&mut self, deadline: Option<Duration>) {
        self.deadline = deadline;
    }

    /// Displacement of a node from its undeformed position, mm.
    #[must_use]
    pub fn displacement_mm(&self, node: usize) -> DVec3 {
        self.displacements_mm[node]
    }

    /// Displacements of the nodes from their undeformed positions, mm; `[n_nodes]`.
    #[must_use]
    pub fn displacements_mm(&self) -> &[DVec3] {
        &self.displacements_mm
    }

    /// Derivative of [`crate::Frame::indenter_force_n`] after the last step along each direction, N
    /// per unit of the parameter.
    #[must_use]
    pub fn force_sensitivities_n(&self) -> Vec<DVec3> {
        let rates = self.sensitivities.iter();
        rates.map(Sensitivity::indenter_force_n).collect()
    }
}

impl SoftBody {
    /// The body at rest, without any previous load.
    #[must_use]
    pub fn rest(&self) -> State {
        State {
            displacements_mm: vec![DVec3::ZERO; self.mesh.nodes_mm.len()],
            pressures_mpa: vec![0.0; self.volume_stiffness.len()],
            history: History::new(self.elements.n_points(), &self.material.prony),
            contacts: std::iter::once(self.settings.friction)
                .chain(self.obstacles.iter().map(|_| self.settings.obstacle_friction))
                .map(|friction| Contact::new(self.boundary.nodes.len(), friction))
                .collect(),
            gel_from_indenter: None,
            last: None,
            stiffness_n_per_mm: None,
            sensitivities: Vec::new(),
            deadline: None,
            unfinished: None,
            uncovered_s: 0.0,
            workspace: Workspace::default(),
        }
    }

    /// The body at rest, for a press whose results are differentiated along some directions.
    ///
    /// # Errors
    /// A direction with a step that is not above zero, with invalid materials, or with another
    /// number of Prony terms; a body with friction, which cannot be differentiated.
    pub fn rest_with_sensitivities(&self, directions: &[Direction]) -> Result<State, SoftBodyError> {
        let mut state = self.rest();
        let SolverSettings {
            friction,
            obstacle_friction,
            ..
        } = self.settings;
        for (field, found) in [("friction", friction), ("obstacle_friction", obstacle_friction)] {
            if found > 0.0 && !directions.is_empty() {
                let expected = "0 where a press is to be differentiated";
                return Err(SoftBodyError::Setting {
                    field,
                    expected,
                    found,
                });
            }
        }
        for direction in directions {
            for material in &direction.materials {
                material.check()?;
                if material.prony.len() != self.material().prony.len() {
                    return Err(SoftBodyError::Direction);
                }
            }
            if !(direction.step.is_finite() && direction.step > 0.0) {
                return Err(SoftBodyError::Direction);
            }
            let of_touches = vec![vec![0.0; self.boundary.nodes.len()]; state.contacts.len()];
            state.sensitivities.push(Sensitivity::zero(
                direction.clone(),
                [self.mesh.nodes_mm.len(), state.pressures_mpa.len()],
                state.history.clone(),
                of_touches,
            ));
        }
        Ok(state)
    }
}
