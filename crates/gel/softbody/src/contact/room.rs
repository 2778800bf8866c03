//! The distance ("room") between the boundary and a shape that does not move. Until the boundary
//! has moved as far, nothing can touch, and nothing needs to be computed.

use std::sync::Arc;

use glam::DVec3;

use super::boundary::Boundary;
use super::rigid_body::RigidBody;
use super::triangle::middles;

/// Smallest distance that is used, mm: a smaller one would soon be gone.
const LEAST_MM: f64 = 0.1;

/// Part of the distance that is kept as a reserve, mm: points that are nearer may count as
/// touching.
const TOUCHING_MM: f64 = 0.01;

/// Largest distance of a point of a triangle from the nearest corner, divided by the longest edge.
const FARTHEST: f64 = 0.58;

/// Distance between the whole boundary and a shape.
#[derive(Clone, Debug)]
pub(super) struct Room {
    mm: f64,
    /// Positions of the boundary's nodes when it was measured, mm.
    measured_at_mm: Arc<Vec<DVec3>>,
}

impl Room {
    /// Measures the distance; `None` if it is too small.
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

    /// Whether both were measured at the same time.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.measured_at_mm, &other.measured_at_mm)
    }

    /// Whether the boundary's nodes have moved as far.
    pub(super) fn is_gone(&self, boundary: &Boundary, node_mm: &dyn Fn(u32) -> DVec3) -> bool {
        let most_mm = self.mm - TOUCHING_MM;
        let mut places_mm = boundary.nodes_mm(node_mm).zip(&*self.measured_at_mm);
        // A position that is NaN counts as having moved too far.
        !places_mm.all(|(now_mm, then_mm)| now_mm.distance_squared(*then_mm) < most_mm * most_mm)
    }
}

/// Distance between a shape and the boundary, mm, at the nodes of the boundary and at the points of
/// its triangles where contact is evaluated; or a lower bound, or a value below [`LEAST_MM`].
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

#[cfg(test)]
mod tests {
    use glam::{DQuat, EulerRot};
    use proptest::prelude::*;
    use twintac_shape::{Pose, Shape, SignedDistance, Surfaces};

    use super::super::point::ContactPoint;
    use super::super::triangle::BoundaryTriangle;
    use super::*;

    /// Number of nodes along each side of a sheet, and the distance between them, mm.
    const N: u32 = 7;
    const EDGE_MM: f64 = 2.0;

    fn sheet() -> (Vec<DVec3>, Boundary) {
        let at = |node: u32| {
            let [x, y] = [node % N, node / N].map(|place| EDGE_MM * f64::from(place));
            DVec3::new(x - 6.0, y - 6.0, 0.0)
        };
        let nodes = (0..N * N).map(|node| ContactPoint::of_node(node, 1.0)).collect();
        let cells = (0..N - 1).flat_map(|row| (0..N - 1).map(move |column| row * N + column));
        let triangles = cells
            .flat_map(|node| [[node, node + 1, node + N], [node + 1, node + N + 1, node + N]])
            .map(|nodes| BoundaryTriangle::new(nodes, nodes.map(Some), nodes.map(at), 1.0))
            .collect();
        ((0..N * N).map(at).collect(), Boundary::new(nodes, triangles))
    }

    fn shape(which: usize) -> Box<dyn SignedDistance> {
        let edge_radius_mm = 0.1;
        let shape = match which {
            0 => Shape::Sphere { radius_mm: 0.5 },
            1 => Shape::Box {
                size_mm: [9.0, 4.0, 0.3], // a plate
                edge_radius_mm,
            },
            2 => Shape::Ring {
                outer_radius_mm: 5.0,
                inner_radius_mm: 4.7,
                height_mm: 10.0,
                edge_radius_mm,
            },
            3 => Shape::X {
                length_mm: 14.0,
                width_mm: 4.0,
                height_mm: 10.0,
                edge_radius_mm,
            },
            _ => Shape::Wedge {
                angle_rad: 1.0,
                length_mm: 12.0,
                height_mm: 8.0,
                edge_radius_mm,
            },
        };
        shape.signed_distance_field(&Surfaces::default()).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

        /// Where contact is skipped there is none: as long as there is room, no point at which
        /// contact is evaluated is inside of the shape.
        #[test]
        fn where_there_is_room_nothing_touches(
            which in 0_usize..5,
            place in prop::array::uniform3(-9.0..9.0),
            turns in prop::array::uniform3(-3.0..3.0),
            moved in prop::collection::vec(prop::array::uniform3(-1.0..1.0), (N * N) as usize),
            amplitude_mm in 0.0..4.0,
        ) {
            let (rest_mm, boundary) = sheet();
            let shape = shape(which);
            let gel_from_shape = Pose {
                position_mm: DVec3::from_array(place),
                rotation: DQuat::from_euler(EulerRot::XYZ, turns[0], turns[1], turns[2]),
            };
            let body = RigidBody { shape: shape.as_ref(), gel_from_shape };
            let Some(room) = Room::measure(&body, &boundary, &|node| rest_mm[node as usize]) else {
                return Ok(());
            };
            let now_mm: Vec<DVec3> = rest_mm
                .iter()
                .zip(&moved)
                .map(|(at_mm, moved)| *at_mm + amplitude_mm * DVec3::from_array(*moved))
                .collect();
            if room.is_gone(&boundary, &|node| now_mm[node as usize]) {
                return Ok(());
            }
            let inside = boundary.triangles.iter().flat_map(|triangle| {
                let [a, b, c] = triangle.nodes.map(|node| now_mm[node as usize]);
                middles().map(move |weights| a * weights[0] + b * weights[1] + c * weights[2])
            });
            for at_mm in now_mm.iter().copied().chain(inside) {
                let local_mm = gel_from_shape.inverse_transform_point(at_mm);
                let distance_mm = shape.signed_distance(local_mm).distance_mm;
                prop_assert!(distance_mm > 0.5 * TOUCHING_MM, "{distance_mm} mm at {at_mm}");
            }
        }
    }

    #[test]
    fn a_place_that_is_no_number_has_no_room() {
        let (mut at_mm, boundary) = sheet();
        let ball = shape(0);
        let body = RigidBody {
            shape: ball.as_ref(),
            gel_from_shape: Pose::from_position(DVec3::new(0.0, 0.0, 5.0)),
        };
        let room = Room::measure(&body, &boundary, &|node| at_mm[node as usize]).expect("there is room");
        assert!(!room.is_gone(&boundary, &|node| at_mm[node as usize]));
        at_mm[3].y = f64::NAN;
        assert!(room.is_gone(&boundary, &|node| at_mm[node as usize]));
    }
}
