//! Checks that an indenter has room to move.

use glam::DVec3;
use twintac_shape::{Pose, SignedDistance};

use super::drive::Drive;
use crate::body::SoftBody;
use crate::contact::{RigidBody, clash};
use crate::state::State;
use crate::{Blocker, SolveError};

/// Distance from the body at which the first motion of an indenter starts, mm.
const CLEARANCE_MM: f64 = 0.01;

/// Largest number of steps to move an indenter out of the body.
const MAX_RETREATS: u32 = 50;

impl SoftBody {
    /// Fails if the indenter would enter something rigid during the motion: there is no gel left
    /// that could stop it.
    pub(super) fn check_way(
        &self,
        state: &State,
        indenter: &dyn SignedDistance,
        drive: &Drive,
    ) -> Result<(), SolveError> {
        let n_parts = (1.0 / drive.largest_part(self.settings.max_travel_mm)).round() as u32;
        // The motion to the first pose is fictitious, so only its end is checked.
        let first = state.gel_from_indenter.map_or(n_parts, |_| 1);
        (first..=n_parts).try_for_each(|part| {
            let moving = RigidBody {
                shape: indenter,
                gel_from_shape: drive.pose(f64::from(part) / f64::from(n_parts)),
            };
            self.check_pose_is_clear(state, &moving)
        })
    }

    fn check_pose_is_clear(&self, state: &State, indenter: &RigidBody) -> Result<(), SolveError> {
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

    /// A start for the motion to an indenter's first pose: straight out of the body, along the mean
    /// of the outward normals where the indenter is inside.
    pub(super) fn retreat(&self, state: &State, indenter: &dyn SignedDistance, pose: &Pose) -> Pose {
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
            // The first direction is kept: as the indenter leaves, fewer and fewer nodes are inside
            // of it.
            if way_out == DVec3::ZERO {
                way_out = normal.normalize_or(DVec3::Z);
            }
            free.position_mm += way_out * (deepest_mm + CLEARANCE_MM);
        }
        free
    }
}
