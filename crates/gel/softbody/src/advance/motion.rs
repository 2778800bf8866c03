//! A motion, in one step or in parts.

use glam::DVec3;
use twintac_shape::{Pose, SignedDistance};

use super::drive::Drive;
use crate::SolveError;
use crate::body::SoftBody;
use crate::clock::Instant;
use crate::contact::{Contact, PassedThrough};
use crate::frame::Frame;
use crate::newton::{Equilibrium, Failure};
use crate::parallel::on_two_threads;
use crate::state::State;

impl SoftBody {
    /// Moves the indenter to a pose within a time, and finds the new equilibrium. A motion that is
    /// too large for one step is halved as often as the settings allow. After an error the state is
    /// as it was before.
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
        state.last = None;
        let drive = Drive::Bonded {
            from,
            to: displacements_mm,
        };
        let frame = self.drive(state, &drive, time_step_s);
        state.last = None;
        frame
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
        let ends_at = state.deadline.map(|deadline| started + deadline);
        state.workspace.buffers(self).ends_at = ends_at.filter(|_| state.sensitivities.is_empty());
        // Only a step in several parts can fail after one of them succeeded.
        let mut before = None;
        let (mut iterations, mut is_settled) = (0, true);
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
            match self.substep(
                state,
                drive,
                [done, next],
                time_step_s * (next - done),
                &mut iterations,
            ) {
                Ok(equilibrium) if next >= 1.0 => {
                    let equilibrium = Equilibrium {
                        is_settled: is_settled && equilibrium.is_settled,
                        ..equilibrium
                    };
                    let wall_time_s = started.elapsed().as_secs_f64();
                    return Ok(self.frame(state, &equilibrium, iterations, wall_time_s));
                }
                Ok(equilibrium) => {
                    is_settled &= equilibrium.is_settled;
                    (done, size) = (next, (2.0 * size).min(largest));
                }
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
                            iterations,
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
                    });
                }
            }
        }
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
