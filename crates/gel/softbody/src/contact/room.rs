//! Room between the boundary and a shape that stays where it is: until the boundary has moved as far, nothing can touch, and nothing needs to be computed.

use std::sync::Arc;

use glam::DVec3;

use super::boundary::Boundary;
use super::rigid_body::RigidBody;
use super::triangle::middles;

/// Room below which there is none, mm: it would soon be gone.
const LEAST_MM: f64 = 0.1;

/// Distance that is no room, mm: what is nearer may count as touching.
const TOUCHING_MM: f64 = 0.01;

/// The farthest that a point of a triangle can be from the nearest corner, over the longest edge.
const FARTHEST: f64 = 0.58;

/// Room between the whole boundary and a shape.
#[derive(Clone, Debug)]
pub(super) struct Room {
    mm: f64,
    /// The boundary's nodes where it was measured, mm.
    measured_at_mm: Arc<Vec<DVec3>>,
}

impl Room {
    /// Measures it; none where it is next to nothing.
    pub(super) fn measure(
        shape: &RigidBody,
        boundary: &Boundary,
        node_mm: &dyn Fn(u32) -> DVec3,
    ) -> Option<Self> {
        let room_mm = room_mm(shape, boundary, node_mm);
        (room_mm >= LEAST_MM).then(|| Self {
            mm: room_mm,
            measured_at_mm: Arc::new(boundary.nodes_mm(node_mm).collect()),
        })
    }

    /// Whether it was measured at the same time.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.measured_at_mm, &other.measured_at_mm)
    }

    /// Whether the boundary's nodes have moved through it.
    pub(super) fn is_gone(&self, boundary: &Boundary, node_mm: &dyn Fn(u32) -> DVec3) -> bool {
        let most_mm = self.mm - TOUCHING_MM;
        let mut places_mm = boundary.nodes_mm(node_mm).zip(&*self.measured_at_mm);
        // A place that is not a number has no room.
        !places_mm.all(|(now_mm, then_mm)| now_mm.distance_squared(*then_mm) < most_mm * most_mm)
    }
}

/// Distance between a shape and the boundary, mm, at its nodes and wherever within its triangles contact is evaluated; or a lower bound, or less than
/// [`LEAST_MM`].
fn room_mm(shape: &RigidBody, boundary: &Boundary, node_mm: &dyn Fn(u32) -> DVec3) -> f64 {
    let distance_mm = |at_mm: DVec3| {
        let local_mm = shape.gel_from_shape.inverse_transform_point(at_mm);
        shape.shape.signed_distance(local_mm).distance_mm
    };
    let mut room_mm = f64::INFINITY;
    for at_mm in boundary.nodes_mm(node_mm) {
        room_mm = room_mm.min(distance_mm(at_mm));
        if room_mm < LEAST_MM {
            return room_mm;
        }
    }
    for triangle in &boundary.triangles {
        let corners_mm = triangle.nodes.map(node_mm);
        let [a, b, c] = corners_mm;
        let longest_mm = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let nearest_mm = corners_mm
            .map(distance_mm)
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let bound_mm = nearest_mm - FARTHEST * longest_mm;
        if bound_mm < room_mm {
            let inside =
                middles().map(|weights| distance_mm(a * weights[0] + b * weights[1] + c * weights[2]));
            room_mm = room_mm.min(inside.fold(f64::INFINITY, f64::min));
        }
        if room_mm < LEAST_MM {
            return room_mm;
        }
    }
    room_mm
}
