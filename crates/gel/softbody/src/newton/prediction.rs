//! The first guess of a step in a new direction.

use super::assembly::for_each_touch;
use super::step::{Failure, Step, Unknowns};
use super::workspace::Buffers;
use crate::body::SoftBody;
use crate::contact::RigidBody;

/// Accuracy of the guess, as that of Newton's directions.
const FORCING: f64 = 0.1;

impl Buffers {
    /// Moves the unknowns, which are at the equilibrium before a step, by their change to first
    /// order in the motion of the shapes, which were at `before`: every point in contact stays in
    /// contact. Returns false, without a change, if nothing is in contact with a shape that moves.
    pub(crate) fn predict(
        &mut self,
        body: &SoftBody,
        step: &Step,
        before: &[RigidBody],
        x: &mut Unknowns,
    ) -> Result<bool, Failure> {
        let moved = step.shapes;
        let before = &Step {
            response: step.response.clone(),
            shapes: before,
        };
        self.damping = 0.0;
        self.evaluate(body, before, x).ok_or(Failure::Inverted)?;
        let mut any = false;
        let (gradient_n, displacements_mm) = (&mut self.gradient_n, &*x.displacements_mm);
        for_each_touch(body, before, x, &mut |of, point, stiffness| {
            let at_mm = body.point_mm(point, displacements_mm);
            // A shape that moves does to the point what the opposite motion of the point would.
            let inside = before.shapes[of].gel_from_shape.inverse_transform_point(at_mm);
            let way_mm = moved[of].gel_from_shape.transform_point(inside) - at_mm;
            let change_n = *stiffness * way_mm;
            any |= change_n.length_squared() > 0.0;
            for (node, part) in point.parts() {
                gradient_n[node as usize] -= change_n * part;
            }
        });
        if any {
            self.find_direction(body, before, x, FORCING)?;
            for (u, direction) in x.displacements_mm.iter_mut().zip(&self.direction_mm) {
                *u += *direction;
            }
            self.has_matrix = true;
        }
        Ok(any)
    }
}
