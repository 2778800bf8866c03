//! Makes the frame of a step.

use std::collections::BTreeSet;

use glam::DVec3;

use crate::body::SoftBody;
use crate::contact::Contact;
use crate::frame::Frame;
use crate::newton::Equilibrium;
use crate::state::State;

impl SoftBody {
    /// Forces and torques at an equilibrium, and the effort to find it.
    pub(super) fn frame(
        &self,
        state: &mut State,
        equilibrium: &Equilibrium,
        behind_mm: f64,
        iterations: u32,
        wall_time_s: f64,
    ) -> Frame {
        let origin_mm = state
            .gel_from_indenter
            .map_or(DVec3::ZERO, |pose| pose.position_mm);
        let at_mm = |node: usize| self.mesh().nodes_mm[node] + state.displacements_mm[node];
        let mut torque = DVec3::ZERO;
        let n_parts = state.n_indenter_parts(self);
        let [mut indenter_force_n, mut obstacle_reaction_n] = [DVec3::ZERO; 2];
        let gradient_n = std::mem::take(&mut state.workspace.buffers(self).gradient_n);
        for (shape, contact) in state.contacts.iter().enumerate() {
            for (point, force) in contact.forces_n(&self.boundary) {
                if shape >= n_parts {
                    obstacle_reaction_n += force;
                } else {
                    indenter_force_n += force;
                    torque += (self.point_mm(point, &state.displacements_mm) - origin_mm).cross(force);
                }
            }
        }
        // The force that is unbalanced at a node in contact is the error of the contact: the forces
        // of the gel are more accurate.
        let parts = state.contacts[..n_parts].iter();
        let pressed: BTreeSet<u32> = parts
            .flat_map(|contact| contact.pressed_nodes(&self.boundary, self.pattern.halves.free))
            .collect();
        for node in pressed {
            let missing = gradient_n[node as usize];
            indenter_force_n += missing;
            torque += (at_mm(node as usize) - origin_mm).cross(missing);
        }
        let held: DVec3 = gradient_n[self.pattern.halves.free..].iter().sum();
        state.workspace.buffers(self).gradient_n = gradient_n;
        Frame {
            indenter_force_n,
            indenter_torque_n_mm: torque,
            board_reaction_n: held,
            obstacle_reaction_n,
            converged: equilibrium.is_settled && behind_mm == 0.0,
            behind_mm,
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
}
