//! Contact with a shape that is too far away to touch: nothing of it is computed until the boundary
//! has moved as far as the shape is away.

use glam::DVec3;

use super::boundary::Boundary;
use super::rigid_body::RigidBody;
use super::room::Room;
use super::state::Contact;

/// Number of steps after which the distance is measured again, if it was too small.
const STEPS: u32 = 8;

impl Contact {
    /// Measures again the distance to a shape that does not move, if the boundary has moved as far
    /// as the last distance, or if that was too small.
    pub(crate) fn look_for_room(
        &mut self,
        shape: &RigidBody,
        boundary: &Boundary,
        node_mm: &dyn Fn(u32) -> DVec3,
    ) {
        if let Some(room) = &self.room {
            if !room.is_gone(boundary, node_mm) {
                return;
            }
            self.room = None;
        } else if self.steps_until_look > 0 {
            self.steps_until_look -= 1;
            return;
        }
        let room = if self.is_untouched() {
            Room::measure(shape, boundary, node_mm)
        } else {
            None
        };
        if room.is_some() {
            self.update_multipliers();
        } else {
            self.steps_until_look = STEPS;
        }
        self.room = room;
    }

    /// If the boundary's nodes have moved too far within a step, which began at `before_mm`,
    /// continues as if the shape had been near from the start of the step.
    pub(crate) fn check_room(
        &mut self,
        shape: &RigidBody,
        boundary: &Boundary,
        [before_mm, now_mm]: [&dyn Fn(u32) -> DVec3; 2],
    ) {
        if self
            .room
            .as_ref()
            .is_some_and(|room| room.is_gone(boundary, now_mm))
        {
            self.room = None;
            self.look_inside(shape, boundary, before_mm);
        }
    }
}
