//! A part of a motion, solved in one step.

use glam::DVec3;
use twintac_shape::Pose;

use super::drive::Drive;
use crate::body::SoftBody;
use crate::contact::{Contact, RigidBody, for_each_contact};
use crate::element::{self, Response};
use crate::newton::{ALMOST, Equilibrium, Failure, Start, Step, Unknowns};
use crate::sensitivity;
use crate::state::{State, Unfinished};

/// Largest number of times that contact points are chosen again within a step.
const MOST_LOOKS: u32 = 3;

impl SoftBody {
    /// Solves a part of a motion, between two fractions of it, or goes on with it. After a failure
    /// the state is as it was before that part.
    // long: the fields of the state are borrowed together
    pub(super) fn substep(
        &self,
        state: &mut State,
        drive: &Drive,
        part: [f64; 2],
        time_step_s: f64,
        start: Start,
        iterations: &mut u32,
    ) -> Result<Equilibrium, Failure> {
        let [from, to] = part.map(|fraction| drive.pose(fraction));
        let [before, shapes] = [from, to].map(|pose| self.shapes(drive, pose));
        let sensitivities_before = state.sensitivities.clone();
        let is_new = start == Start::Anew;
        if is_new {
            state.take_parts(self, self.n_indenter_parts(shapes.len()));
            self.begin(state, [&before, &shapes]);
            drive.hold(self, part[1], &mut state.displacements_mm);
        }
        let State {
            displacements_mm,
            pressures_mpa,
            history,
            contacts,
            workspace,
            last,
            sensitivities,
            ..
        } = &mut *state;
        let buffers = workspace.buffers(self);
        buffers.keeps_passed = !sensitivities.is_empty();
        let step = Step {
            response: Response::new(self.material(), time_step_s, history),
            shapes: &shapes,
        };
        let mut x = Unknowns {
            displacements_mm,
            pressures_mpa,
            contacts,
        };
        let travel_mm = drive.travel_mm(part);
        let turns = from != to && !last.as_ref().is_some_and(|last| last.is_followed_by(travel_mm));
        let is_ahead = is_new
            && (turns && buffers.predict(self, &step, &before, &mut x).unwrap_or(false)
                || last
                    .as_ref()
                    .is_some_and(|last| last.go_on(travel_mm, x.displacements_mm)));
        if is_ahead {
            drive.hold(self, part[1], x.displacements_mm);
        }
        let iterations_before = *iterations;
        buffers.passed.clear();
        let mut solved = buffers.solve(self, &step, &mut x, start, iterations);
        if is_ahead && *iterations == iterations_before && matches!(solved, Err(Failure::Inverted)) {
            // At the extrapolated displacements a tetrahedron is inverted.
            x.displacements_mm.copy_from_slice(&buffers.old.displacements_mm);
            drive.hold(self, part[1], x.displacements_mm);
            solved = buffers.solve(self, &step, &mut x, Start::Anew, iterations);
        }
        // After a long motion, other triangles are at the rims of the shape than at the start of
        // the step. If the points were not chosen again, the force would continue to change while
        // the shape is held.
        for _ in 0..MOST_LOOKS {
            if !solved.is_ok_and(|equilibrium| equilibrium.is_settled) || !self.look_again(&shapes, &mut x) {
                break;
            }
            solved = buffers.solve(self, &step, &mut x, Start::Again, iterations);
        }
        if let Ok(equilibrium) = &solved
            && !equilibrium.is_settled
            && equilibrium.residual > ALMOST
        {
            let beginning = std::mem::take(&mut buffers.old);
            state.unfinished = Some(Unfinished {
                from,
                to,
                time_step_s,
                iterations: *iterations - iterations_before,
                pose_before: state.gel_from_indenter.replace(to),
                beginning,
            });
            return solved;
        }
        let solved = solved.and_then(|equilibrium| {
            self.check_sides([&before, &shapes], &x, &buffers.old.displacements_mm)?;
            sensitivity::follow(self, buffers, &step, &mut x, sensitivities)?;
            Ok(equilibrium)
        });
        if solved.is_ok() {
            self.settle_friction(&shapes, &mut x);
            let relaxation = step.response.relaxation;
            element::update_history(
                &self.elements,
                self.material(),
                &relaxation,
                displacements_mm,
                history,
            );
            if travel_mm != DVec3::ZERO {
                last.get_or_insert_default()
                    .set(travel_mm, displacements_mm, &buffers.old.displacements_mm);
            }
            if let Drive::Indenter { .. } = drive {
                state.gel_from_indenter = Some(to);
            }
        } else {
            *sensitivities = sensitivities_before;
            let beginning = std::mem::take(&mut buffers.old);
            state.go_back_to(beginning);
        }
        solved
    }

    /// The parts of the indenter at a pose, followed by the obstacles.
    fn shapes<'a>(&'a self, drive: &'a Drive, gel_from_indenter: Pose) -> Vec<RigidBody<'a>> {
        let mut shapes = RigidBody::parts(drive.shape(), gel_from_indenter);
        shapes.extend(self.obstacles.iter().map(|(shape, pose)| RigidBody {
            shape: shape.as_ref(),
            gel_from_shape: *pose,
        }));
        shapes
    }

    /// Prepares the contacts for a step that starts with the shapes `before`, and saves the
    /// unknowns.
    fn begin(&self, state: &mut State, [before, shapes]: [&[RigidBody]; 2]) {
        let n_parts = state.n_indenter_parts(self);
        let State {
            displacements_mm,
            pressures_mpa,
            contacts,
            workspace,
            ..
        } = state;
        contacts[..n_parts].iter_mut().for_each(Contact::forget_distances);
        let at_mm = |node: u32| self.mesh().nodes_mm[node as usize] + displacements_mm[node as usize];
        for_each_contact(shapes, contacts, |index, shape, contact| {
            // Only obstacles are checked for distance, because the indenter moves.
            if index >= n_parts {
                contact.look_for_room(shape, &self.boundary, &at_mm);
                contact.look_inside_again(shape, &self.boundary, &at_mm);
            } else {
                contact.look_inside(shape, &self.boundary, &at_mm);
            }
        });
        let old = &mut workspace.buffers(self).old;
        old.displacements_mm.clone_from(displacements_mm);
        old.pressures_mpa.clone_from(pressures_mpa);
        old.contacts.clone_from(contacts);
        contacts.iter_mut().for_each(Contact::update_multipliers);
        for (shape, contact) in before.iter().zip(contacts.iter_mut()) {
            if let Some((friction, touches)) = contact.friction_mut() {
                friction.begin(shape, touches, self.boundary_mm(displacements_mm));
            }
        }
    }

    /// Chooses the points at which contact is evaluated again; returns whether they have changed.
    fn look_again(&self, shapes: &[RigidBody], x: &mut Unknowns) -> bool {
        let displacements_mm = &*x.displacements_mm;
        let at_mm = |node: u32| self.mesh.nodes_mm[node as usize] + displacements_mm[node as usize];
        let are_others = for_each_contact(shapes, x.contacts, |_, shape, contact| {
            contact.look_again(shape, &self.boundary, &at_mm)
        });
        are_others.contains(&true)
    }

    /// Fails if the indenter and the body have passed through each other.
    fn check_sides(
        &self,
        [before, now]: [&[RigidBody]; 2],
        x: &Unknowns,
        old_mm: &[DVec3],
    ) -> Result<(), Failure> {
        let place_mm = |node: u32, displacements_mm: &[DVec3]| {
            self.mesh.nodes_mm[node as usize] + displacements_mm[node as usize]
        };
        let now_mm = |node: u32| place_mm(node, x.displacements_mm);
        let before_mm = |node: u32| place_mm(node, old_mm);
        let n_parts = self.n_indenter_parts(now.len());
        for ((before, now), contact) in before.iter().zip(now).zip(x.contacts.iter()).take(n_parts) {
            let changed = || contact.changed_sides([before, now], &self.boundary, [&before_mm, &now_mm]);
            if let Some(passed) = contact.pierced(now, &now_mm).or_else(changed) {
                return Err(Failure::PassedThrough(passed));
            }
            if let Some(pulled) = contact.pulled(&self.boundary, &now_mm) {
                return Err(Failure::Pulled(pulled));
            }
        }
        Ok(())
    }

    fn settle_friction(&self, shapes: &[RigidBody], x: &mut Unknowns) {
        for (shape, contact) in shapes.iter().zip(x.contacts.iter_mut()) {
            if let Some((friction, touches)) = contact.friction_mut() {
                let nodes = self.boundary_mm(x.displacements_mm);
                friction.settle(shape, touches, nodes);
            }
        }
    }
}
