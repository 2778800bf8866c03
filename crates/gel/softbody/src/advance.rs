//! Taking a press from one pose of the indenter to the next.

use std::time::Instant;

use glam::DVec3;
use twintac_shape::{Pose, SignedDistance};

use crate::body::SoftBody;
use crate::contact::{Contact, RigidBody, clash};
use crate::element::{self, Forces, Response};
use crate::newton::{Equilibrium, Failure, Step, Unknowns};
use crate::parallel::on_two_threads;
use crate::relaxation::Relaxation;
use crate::state::{Frame, State};
use crate::{Blocker, SolveError, sensitivity};

/// Where an indenter with no past starts from if it can't be put in place at once: this far off the body, mm.
const CLEARANCE_MM: f64 = 0.01;

/// Moves after which an indenter is taken to be out of the body.
const MAX_RETREATS: u32 = 50;

/// Part of its smallest dimension by which an indenter may move at once.
const THICKNESS_PART: f64 = 0.25;

/// How far past the last motion the next may be extrapolated.
const MAX_EXTRAPOLATION: f64 = 2.0;

impl SoftBody {
    /// Moves the indenter to a pose within a time, and finds the new equilibrium. A motion too large for one step is halved as
    /// often as the settings allow. On an error the state stays as it was.
    pub fn advance(
        &self,
        state: &mut State,
        indenter: &dyn SignedDistance,
        gel_from_indenter: &Pose,
        time_step_s: f64,
    ) -> Result<Frame, SolveError> {
        check_pose(gel_from_indenter)?;
        let start = state
            .gel_from_indenter
            .unwrap_or_else(|| self.retreat(state, indenter, gel_from_indenter));
        let drive = Drive::Indenter {
            shape: indenter,
            from: start,
            to: *gel_from_indenter,
        };
        self.check_way(state, indenter, &drive)?;
        self.drive(state, &drive, time_step_s)
    }

    /// Moves the bonded nodes, with no indenter: `displacements_mm` is in the order of the mesh's set of bonded nodes.
    pub fn advance_prescribed(
        &self,
        state: &mut State,
        displacements_mm: &[DVec3],
        time_step_s: f64,
    ) -> Result<Frame, SolveError> {
        let bonded = &self.mesh().sets.bonded;
        if displacements_mm.len() != bonded.len() || displacements_mm.iter().any(|u| !u.is_finite()) {
            return Err(SolveError::Input {
                what: "prescribed displacements",
                expected: format!("{} finite vectors", bonded.len()),
                found: format!("{} vectors", displacements_mm.len()),
            });
        }
        let from = bonded
            .iter()
            .map(|&node| state.displacements_mm[node as usize])
            .collect();
        self.drive(
            state,
            &Drive::Bonded {
                from,
                to: displacements_mm,
            },
            time_step_s,
        )
    }

    fn drive(&self, state: &mut State, drive: &Drive, time_step_s: f64) -> Result<Frame, SolveError> {
        if self.on_two_threads {
            on_two_threads(|| self.drive_alone(state, drive, time_step_s))
        } else {
            self.drive_alone(state, drive, time_step_s)
        }
    }

    fn drive_alone(&self, state: &mut State, drive: &Drive, time_step_s: f64) -> Result<Frame, SolveError> {
        let started = Instant::now();
        if !(time_step_s.is_finite() && time_step_s >= 0.0) {
            return Err(SolveError::Input {
                what: "time step",
                expected: "a finite number of s, 0 or above".into(),
                found: format!("{time_step_s} s"),
            });
        }
        // Only a step in several parts can fail after one of them.
        let mut before = None;
        let mut iterations = 0;
        let largest = drive.largest_part(self.settings.max_travel_mm);
        let (mut done, mut size) = (0.0, largest);
        loop {
            // The last part takes what round-off leaves.
            let next = if done + size > 1.0 - 1e-9 {
                1.0
            } else {
                done + size
            };
            if next < 1.0 && before.is_none() {
                before = Some(state.clone());
            }
            match self.substep(
                state,
                drive,
                [done, next],
                time_step_s * (next - done),
                &mut iterations,
            ) {
                Ok(equilibrium) if next >= 1.0 => {
                    let wall_time_s = started.elapsed().as_secs_f64();
                    return Ok(self.frame(state, &equilibrium, iterations, wall_time_s));
                }
                Ok(_) => (done, size) = (next, (2.0 * size).min(largest)),
                Err(_) if 0.5 * size >= self.settings.min_substep * largest => {
                    size *= 0.5;
                    state.contacts.iter_mut().for_each(Contact::drop_carried);
                }
                Err(failure) => {
                    if let Some(before) = before {
                        let workspace = std::mem::take(&mut state.workspace);
                        *state = State { workspace, ..before };
                    }
                    return Err(match failure {
                        Failure::NotConverged { residual } => SolveError::NotConverged {
                            fraction: done,
                            residual,
                            iterations,
                        },
                        Failure::Inverted => SolveError::Inverted { fraction: done },
                        Failure::Singular => SolveError::Singular { fraction: done },
                    });
                }
            }
        }
    }

    /// Solves for a part of a step; on failure the state is as before.
    fn substep(
        &self,
        state: &mut State,
        drive: &Drive,
        part: [f64; 2],
        time_step_s: f64,
        iterations: &mut u32,
    ) -> Result<Equilibrium, Failure> {
        let relaxation = Relaxation::new(&self.material().prony, time_step_s);
        let [from, to] = part.map(|fraction| drive.pose(fraction));
        let mut shapes = Vec::with_capacity(1 + self.obstacles.len());
        shapes.push(RigidBody {
            shape: drive.shape(),
            gel_from_shape: to,
        });
        shapes.extend(self.obstacles.iter().map(|(shape, pose)| RigidBody {
            shape: shape.as_ref(),
            gel_from_shape: *pose,
        }));
        let State {
            displacements_mm,
            pressures_mpa,
            memory,
            contacts,
            workspace,
            last,
            sensitivities,
            ..
        } = &mut *state;
        contacts[0].forget_distances();
        let at_mm = |node: u32| self.mesh().nodes_mm[node as usize] + displacements_mm[node as usize];
        for (shape, contact) in shapes.iter().zip(contacts.iter_mut()) {
            contact.look_inside(shape, &self.boundary, &at_mm);
        }
        let buffers = workspace.buffers(self);
        buffers.old.displacements_mm.clone_from(displacements_mm);
        buffers.old.pressures_mpa.clone_from(pressures_mpa);
        buffers.old.contacts.clone_from(contacts);
        buffers.old.sensitivities.clone_from(sensitivities);
        contacts.iter_mut().for_each(Contact::carry);
        for (index, contact) in contacts.iter_mut().enumerate() {
            if let Some(friction) = &mut contact.friction {
                let start = match index {
                    0 => from,
                    _ => shapes[index].gel_from_shape,
                };
                let shape = RigidBody {
                    gel_from_shape: start,
                    ..shapes[index]
                };
                friction.begin(&shape, &contact.touches, self.boundary_mm(displacements_mm));
            }
        }
        drive.hold(self, part[1], displacements_mm);
        buffers.keeps_passed = !sensitivities.is_empty();
        let step = Step {
            response: Response {
                material: self.material(),
                relaxation: &relaxation,
                memory,
            },
            shapes: &shapes,
        };
        let mut x = Unknowns {
            displacements_mm,
            pressures_mpa,
            contacts,
        };
        let travel_mm = to.position_mm - from.position_mm;
        let ratio = last
            .as_ref()
            .map_or(0.0, |last| extrapolation(last.travel_mm, travel_mm));
        if let Some(last) = last.as_ref().filter(|_| ratio != 0.0) {
            for (u, change) in x.displacements_mm.iter_mut().zip(&last.displacements_mm) {
                *u += *change * ratio;
            }
            if !buffers.is_valid(self, &mut x) {
                x.displacements_mm.copy_from_slice(&buffers.old.displacements_mm);
                drive.hold(self, part[1], x.displacements_mm);
            }
        }
        let solved = buffers
            .solve(self, &step, &mut x, iterations)
            .and_then(|equilibrium| {
                sensitivity::follow(self, buffers, &step, &mut x, sensitivities)?;
                Ok(equilibrium)
            });
        match solved {
            Ok(equilibrium) => {
                for (shape, contact) in shapes.iter().zip(x.contacts.iter_mut()) {
                    if let Some(friction) = &mut contact.friction {
                        let nodes = self.boundary_mm(x.displacements_mm);
                        friction.settle(shape, &contact.touches, nodes);
                    }
                }
                element::remember(
                    &self.elements,
                    self.material(),
                    &relaxation,
                    displacements_mm,
                    memory,
                );
                if let Drive::Indenter { .. } = drive {
                    if travel_mm != DVec3::ZERO {
                        let motion = last.get_or_insert_default();
                        motion.travel_mm = travel_mm;
                        let ends = displacements_mm.iter().zip(&buffers.old.displacements_mm);
                        motion.displacements_mm.clear();
                        motion.displacements_mm.extend(ends.map(|(new, old)| *new - *old));
                    }
                    state.gel_from_indenter = Some(to);
                }
                Ok(equilibrium)
            }
            Err(failure) => {
                displacements_mm.clone_from(&buffers.old.displacements_mm);
                pressures_mpa.clone_from(&buffers.old.pressures_mpa);
                contacts.clone_from(&buffers.old.contacts);
                sensitivities.clone_from(&buffers.old.sensitivities);
                Err(failure)
            }
        }
    }

    fn frame(
        &self,
        state: &mut State,
        equilibrium: &Equilibrium,
        iterations: u32,
        wall_time_s: f64,
    ) -> Frame {
        let origin_mm = state
            .gel_from_indenter
            .map_or(DVec3::ZERO, |pose| pose.position_mm);
        let at_mm = |node: usize| self.mesh().nodes_mm[node] + state.displacements_mm[node];
        let mut torque = DVec3::ZERO;
        let mut forces = vec![DVec3::ZERO; state.contacts.len()];
        let gradient_n = std::mem::take(&mut state.workspace.buffers(self).gradient_n);
        for (shape, contact) in state.contacts.iter().enumerate() {
            for (point, force) in contact.forces_n(&self.boundary) {
                forces[shape] += force;
                if shape == 0 {
                    torque += (self.point_mm(point, &state.displacements_mm) - origin_mm).cross(force);
                }
            }
        }
        // What is left unbalanced at a node in touch is the contact's own error: the gel's forces are known better.
        for node in state.contacts[0].pressed_nodes(&self.boundary, self.pattern.halves.free) {
            let missing = gradient_n[node as usize];
            forces[0] += missing;
            torque += (at_mm(node as usize) - origin_mm).cross(missing);
        }
        let held: DVec3 = gradient_n[self.pattern.halves.free..].iter().sum();
        state.workspace.buffers(self).gradient_n = gradient_n;
        Frame {
            indenter_force_n: forces[0],
            indenter_torque_n_mm: torque,
            board_reaction_n: held,
            obstacle_reaction_n: forces[1..].iter().sum(),
            converged: true,
            iterations,
            residual: equilibrium.residual,
            penetration_mm: state
                .contacts
                .iter()
                .map(Contact::penetration_mm)
                .fold(0.0, f64::max),
            smallest_volume_ratio: equilibrium.smallest_volume_ratio,
            wall_time_s,
            cost: std::mem::take(&mut state.workspace.buffers(self).cost),
        }
    }

    /// The forces that hold the bonded nodes, in their order, N. `[n_bonded]`
    #[must_use]
    pub fn bonded_forces_n(&self, state: &State) -> Vec<DVec3> {
        let now = Relaxation::new(&self.material().prony, 0.0);
        let response = self.response(&now, state);
        let (mut forces, mut corners) = (Forces::default(), Vec::new());
        self.corner_pressures(&state.pressures_mpa, &mut corners);
        self.elements
            .forces(response, &state.displacements_mm, &corners, &mut forces);
        let forces = forces.forces_n.as_flattened();
        self.mesh()
            .sets
            .bonded
            .iter()
            .map(|&node| {
                let range = self.force_starts[node as usize]..self.force_starts[node as usize + 1];
                let sources = &self.force_sources[range.start as usize..range.end as usize];
                sources.iter().map(|&source| forces[source as usize]).sum()
            })
            .collect()
    }

    /// Refuses an indenter that would reach into something rigid on its way: no gel is left there that could stop it.
    fn check_way(
        &self,
        state: &State,
        indenter: &dyn SignedDistance,
        drive: &Drive,
    ) -> Result<(), SolveError> {
        let n_parts = (1.0 / drive.largest_part(self.settings.max_travel_mm)).round() as u32;
        // The way of an indenter without a past is made up.
        let first = state.gel_from_indenter.map_or(n_parts, |_| 1);
        (first..=n_parts).try_for_each(|part| {
            let moving = RigidBody {
                shape: indenter,
                gel_from_shape: drive.pose(f64::from(part) / f64::from(n_parts)),
            };
            self.check_place(state, &moving)
        })
    }

    fn check_place(&self, state: &State, indenter: &RigidBody) -> Result<(), SolveError> {
        for &node in &self.mesh().sets.bonded {
            let at_mm = self.mesh().nodes_mm[node as usize] + state.displacements_mm[node as usize];
            let local_mm = indenter.gel_from_shape.inverse_transform_point(at_mm);
            let distance_mm = indenter.shape.signed_distance(local_mm).distance_mm;
            if distance_mm < -self.settings.penetration_mm {
                return Err(SolveError::Blocked {
                    by: Blocker::Bonded,
                    at_mm,
                    depth_mm: -distance_mm,
                });
            }
        }
        for (shape, pose) in &self.obstacles {
            let obstacle = RigidBody {
                shape: shape.as_ref(),
                gel_from_shape: *pose,
            };
            if let Some((at_mm, depth_mm)) = clash(indenter, &obstacle) {
                return Err(SolveError::Blocked {
                    by: Blocker::Obstacle,
                    at_mm,
                    depth_mm,
                });
            }
        }
        Ok(())
    }

    /// Where an indenter without a past comes from: straight out of the body, along the mean of the outward normals where it is inside.
    fn retreat(&self, state: &State, indenter: &dyn SignedDistance, pose: &Pose) -> Pose {
        let mesh = self.mesh();
        let mut normals = vec![DVec3::ZERO; mesh.nodes_mm.len()];
        for triangle in mesh.boundary_triangles() {
            let area_vector = mesh.area_vector_mm2(&triangle);
            triangle
                .iter()
                .for_each(|&node| normals[node as usize] += area_vector);
        }
        let mut free = *pose;
        let mut way_out = DVec3::ZERO;
        for _ in 0..MAX_RETREATS {
            let mut deepest_mm: f64 = 0.0;
            let mut normal = DVec3::ZERO;
            for (point, at_mm) in self.boundary_mm(&state.displacements_mm) {
                let gap_mm = indenter
                    .signed_distance(free.inverse_transform_point(at_mm))
                    .distance_mm;
                if gap_mm < 0.0 {
                    normal += point.value(&normals);
                    deepest_mm = deepest_mm.max(-gap_mm);
                }
            }
            if deepest_mm == 0.0 {
                break;
            }
            // The first answer stays: as the indenter leaves, ever fewer nodes are asked.
            if way_out == DVec3::ZERO {
                way_out = normal.normalize_or(DVec3::Z);
            }
            free.position_mm += way_out * (deepest_mm + CLEARANCE_MM);
        }
        free
    }
}

/// What moves.
enum Drive<'a> {
    Indenter {
        shape: &'a dyn SignedDistance,
        from: Pose,
        to: Pose,
    },
    Bonded {
        from: Vec<DVec3>,
        to: &'a [DVec3],
    },
}

impl Drive<'_> {
    fn pose(&self, fraction: f64) -> Pose {
        match self {
            Self::Indenter { from, to, .. } if fraction < 1.0 => Pose {
                position_mm: from.position_mm.lerp(to.position_mm, fraction),
                rotation: from.rotation.slerp(to.rotation, fraction),
            },
            Self::Indenter { to, .. } => *to,
            Self::Bonded { .. } => Pose::IDENTITY,
        }
    }

    /// Largest part of the motion that may be taken at once: a node that a moving shape has swallowed must still be nearest to the side
    /// by which it came in.
    fn largest_part(&self, max_travel_mm: f64) -> f64 {
        let Self::Indenter { shape, from, to } = self else {
            return 1.0;
        };
        let (low, high) = shape.bounds_mm();
        let reach_mm = low.abs().max(high.abs()).length();
        let turn = from.rotation.angle_between(to.rotation);
        let travel_mm = from.position_mm.distance(to.position_mm) + turn * reach_mm;
        let limit_mm = max_travel_mm.min(THICKNESS_PART * (high - low).min_element());
        if travel_mm > limit_mm && limit_mm > 0.0 {
            1.0 / (travel_mm / limit_mm).ceil()
        } else {
            1.0
        }
    }

    fn shape(&self) -> &dyn SignedDistance {
        match self {
            Self::Indenter { shape, .. } => *shape,
            Self::Bonded { .. } => &Nothing,
        }
    }

    /// Puts the bonded nodes where they are to be.
    fn hold(&self, body: &SoftBody, fraction: f64, displacements_mm: &mut [DVec3]) {
        if let Self::Bonded { from, to } = self {
            for ((&node, from), to) in body.mesh().sets.bonded.iter().zip(from).zip(*to) {
                displacements_mm[node as usize] = from.lerp(*to, fraction);
            }
        }
    }
}

/// No shape at all.
struct Nothing;

impl SignedDistance for Nothing {
    fn signed_distance(&self, _: DVec3) -> twintac_shape::Distance {
        twintac_shape::Distance {
            distance_mm: f64::MAX,
            gradient: DVec3::Z,
        }
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        (DVec3::ZERO, DVec3::ZERO)
    }
}

/// How much of the last motion the next one is, backwards included: presses are extrapolated in depth, not in time.
fn extrapolation(last_mm: DVec3, next_mm: DVec3) -> f64 {
    let size = last_mm.length_squared();
    if size > 0.0 {
        (last_mm.dot(next_mm) / size).clamp(-1.0, MAX_EXTRAPOLATION)
    } else {
        0.0
    }
}

fn check_pose(pose: &Pose) -> Result<(), SolveError> {
    if pose.position_mm.is_finite() && pose.rotation.is_finite() && pose.rotation.is_normalized() {
        return Ok(());
    }
    Err(SolveError::Input {
        what: "pose of the indenter",
        expected: "finite numbers and a unit quaternion".into(),
        found: format!("{pose:?}"),
    })
}
