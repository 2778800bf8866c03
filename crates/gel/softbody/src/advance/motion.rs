//! A motion, in one step or in parts.

use glam::DVec3;
use twintac_shape::{Pose, SignedDistance};

use super::drive::{Drive, way_mm};
use crate::SolveError;
use crate::body::SoftBody;
use crate::clock::Instant;
use crate::contact::{Contact, PassedThrough, Pulled, RigidBody};
use crate::frame::Frame;
use crate::newton::{Equilibrium, Failure, Start};
use crate::parallel::on_two_threads;
use crate::state::{State, Unfinished};

/// What has become of the step that a deadline had ended.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Last {
    /// There is none any more.
    Finished,
    /// It still has to go on, from this end and pose.
    Unfinished(Equilibrium, Pose),
    /// The state is as it was before that step, which needs more time.
    TakenBack,
}

impl SoftBody {
    /// Moves the indenter to a pose within a time, and finds the new equilibrium. A motion that is
    /// too large for one step is halved as often as the settings allow. After an error the state is
    /// as it was before, except that a step that a deadline had ended is finished or taken back.
    pub fn advance(
        &self,
        state: &mut State,
        indenter: &dyn SignedDistance,
        gel_from_indenter: &Pose,
        time_step_s: f64,
    ) -> Result<Frame, SolveError> {
        check_pose(gel_from_indenter)?;
        check_time_step(time_step_s)?;
        self.on_its_threads(|| self.move_to(state, indenter, gel_from_indenter, time_step_s))
    }

    fn move_to(
        &self,
        state: &mut State,
        indenter: &dyn SignedDistance,
        gel_from_indenter: &Pose,
        time_step_s: f64,
    ) -> Result<Frame, SolveError> {
        let started = Instant::now();
        let mut iterations = 0;
        let deadline = state.deadline.filter(|_| state.sensitivities.is_empty());
        // Finishing the last step leaves time for an iteration of this one.
        let iteration = state.workspace.buffers(self).iteration;
        let ends_at = deadline.map(|deadline| started + deadline.saturating_sub(iteration));
        let last = self.finish(state, indenter, ends_at, &mut iterations);
        let (equilibrium, behind_mm) = match last {
            Last::Unfinished(equilibrium, pose) => {
                state.uncovered_s += time_step_s;
                (equilibrium, way_mm(indenter, &pose, gel_from_indenter))
            }
            Last::Finished | Last::TakenBack => {
                let start = state
                    .gel_from_indenter
                    .unwrap_or_else(|| self.retreat(state, indenter, gel_from_indenter));
                let drive = Drive::Indenter {
                    shape: indenter,
                    from: start,
                    to: *gel_from_indenter,
                };
                self.check_way(state, indenter, &drive)?;
                let deadline = deadline.filter(|_| last == Last::Finished);
                state.workspace.buffers(self).ends_at = deadline.map(|deadline| started + deadline);
                let time_step_s = state.uncovered_s + time_step_s;
                self.drive(state, &drive, time_step_s, &mut iterations)?
            }
        };
        let wall_time_s = started.elapsed().as_secs_f64();
        Ok(self.frame(state, &equilibrium, behind_mm, iterations, wall_time_s))
    }

    /// Goes on with the step that a deadline has ended, until the forces are almost balanced. A
    /// step that fails, or that has had as many iterations as a step may have, is taken back.
    pub(crate) fn finish(
        &self,
        state: &mut State,
        shape: &dyn SignedDistance,
        ends_at: Option<Instant>,
        iterations: &mut u32,
    ) -> Last {
        let Some(unfinished) = state.unfinished.take() else {
            return Last::Finished;
        };
        let Unfinished { from, to, .. } = unfinished;
        let is_same = state.n_indenter_parts(self) == RigidBody::parts(shape, to).len();
        if !is_same || unfinished.iterations >= self.settings.max_iterations {
            state.take_back(unfinished);
            return if is_same { Last::TakenBack } else { Last::Finished };
        }
        let buffers = state.workspace.buffers(self);
        buffers.ends_at = ends_at;
        // After a failure, the step itself goes back to its beginning.
        buffers.old = unfinished.beginning;
        let drive = Drive::Indenter { shape, from, to };
        let (time_step_s, iterations_before) = (unfinished.time_step_s, *iterations);
        let found = self.substep(state, &drive, [0.0, 1.0], time_step_s, Start::GoOn, iterations);
        match (found, &mut state.unfinished) {
            (Ok(equilibrium), Some(still)) => {
                still.iterations = unfinished.iterations + *iterations - iterations_before;
                still.pose_before = unfinished.pose_before;
                Last::Unfinished(equilibrium, to)
            }
            (Ok(_), None) => Last::Finished,
            (Err(_), _) => {
                state.gel_from_indenter = unfinished.pose_before;
                state.uncovered_s += time_step_s;
                Last::TakenBack
            }
        }
    }

    /// Moves the bonded nodes, without an indenter. `displacements_mm` has the order of the mesh's
    /// set of bonded nodes.
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
        check_time_step(time_step_s)?;
        if let Some(unfinished) = state.unfinished.take() {
            state.take_back(unfinished);
        }
        let time_step_s = state.uncovered_s + time_step_s;
        state.last = None;
        state.workspace.buffers(self).ends_at = None;
        let drive = Drive::Bonded {
            from,
            to: displacements_mm,
        };
        let (started, mut iterations) = (Instant::now(), 0);
        let found = self.on_its_threads(|| self.drive(state, &drive, time_step_s, &mut iterations));
        state.last = None;
        let (equilibrium, behind_mm) = found?;
        let wall_time_s = started.elapsed().as_secs_f64();
        Ok(self.frame(state, &equilibrium, behind_mm, iterations, wall_time_s))
    }

    fn on_its_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        if self.on_two_threads {
            on_two_threads(work)
        } else {
            work()
        }
    }

    /// Moves in one step or in parts. Returns the equilibrium at the end, or where a deadline ended
    /// the motion, and how far from the end that is, mm.
    fn drive(
        &self,
        state: &mut State,
        drive: &Drive,
        time_step_s: f64,
        iterations: &mut u32,
    ) -> Result<(Equilibrium, f64), SolveError> {
        // Only a step in several parts can fail after one of them succeeded.
        let mut before = None;
        let largest = drive.largest_part(self.settings.max_travel_mm);
        let (mut done, mut size) = (0.0, largest);
        loop {
            // The last part ends exactly at 1.
            let next = if done + size > 1.0 - 1e-9 {
                1.0
            } else {
                done + size
            };
            if next < 1.0 && before.is_none() {
                before = Some(state.clone());
            }
            let part_s = time_step_s * (next - done);
            match self.substep(state, drive, [done, next], part_s, Start::Anew, iterations) {
                Ok(equilibrium) if next >= 1.0 || !equilibrium.is_settled => {
                    state.uncovered_s = time_step_s * (1.0 - next);
                    return Ok((equilibrium, drive.left_mm(next)));
                }
                Ok(_) => (done, size) = (next, (2.0 * size).min(largest)),
                Err(_) if 0.5 * size >= self.settings.min_substep * largest => {
                    size *= 0.5;
                    state.contacts.iter_mut().for_each(Contact::drop_multipliers);
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
                            iterations: *iterations,
                        },
                        Failure::Inverted => SolveError::Inverted { fraction: done },
                        Failure::Singular => SolveError::Singular { fraction: done },
                        Failure::PassedThrough(PassedThrough {
                            at_mm,
                            reach_mm,
                            thickness_mm,
                            edge_mm,
                        }) => SolveError::PassedThrough {
                            fraction: done,
                            at_mm,
                            reach_mm,
                            thickness_mm,
                            edge_mm,
                        },
                        Failure::Pulled(Pulled { at_mm, edge_mm }) => SolveError::Pulled {
                            fraction: done,
                            at_mm,
                            edge_mm,
                        },
                    });
                }
            }
        }
    }
}

fn check_time_step(time_step_s: f64) -> Result<(), SolveError> {
    if time_step_s.is_finite() && time_step_s >= 0.0 {
        return Ok(());
    }
    Err(SolveError::Input {
        what: "time step",
        expected: "a finite number of s, 0 or above".into(),
        found: format!("{time_step_s} s"),
    })
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
