//! Whether gel and shape have passed through each other: what a solution must not have, whatever its residual says.
//!
//! A point of the boundary knows of a shape the nearest face alone. A wall that is thinner than a step goes past a node from one side to the other, and one that is
//! thinner than a triangle goes through between its corners; either way the forces balance. So it is looked at afterwards.

use glam::DVec3;

use super::boundary::Boundary;
use super::rigid_body::RigidBody;
use super::state::Contact;

/// A shape is a wall where it is thinner than this part of the longest edge of the triangle that it goes through.
const WALL: f64 = 0.5;

/// How far a wall may reach through a triangle, as part of its thickness.
const MOST_OF_THICKNESS: f64 = 0.6;

/// Cosine of the angle between the outward normals at both ends of a way below which these are on opposite sides of a shape.
const OPPOSITE: f64 = -0.5;

/// A point that is less deep than this is on the surface, mm.
const ON_SURFACE_MM: f64 = 1e-3;

/// Steps of a way through a shape, or up to it, at most.
const MOST_STEPS: u32 = 64;

/// A place at which gel and shape have passed through each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PassedThrough {
    pub(crate) at_mm: DVec3,
    /// How far the shape reaches into the gel, mm.
    pub(crate) reach_mm: f64,
    /// Thickness of the shape there, mm.
    pub(crate) thickness_mm: f64,
    /// Longest edge of the boundary's triangles there, mm.
    pub(crate) edge_mm: f64,
}

impl Contact {
    /// A triangle through which a wall of the shape goes, if there is one.
    pub(crate) fn pierced(&self, shape: &RigidBody, node_mm: &dyn Fn(u32) -> DVec3) -> Option<PassedThrough> {
        self.points_inside().find_map(|(point, edge_mm, touch)| {
            if touch.force_n <= 0.0 || touch.measured_mm > -ON_SURFACE_MM {
                return None;
            }
            let [a, b, c] = point.corners().map(node_mm);
            let inwards = (c - a).cross(b - a).normalize_or_zero();
            let at_mm = point.parts().map(|(node, part)| node_mm(node) * part).sum();
            let aside = shape.normal(at_mm).reject_from(inwards).try_normalize()?;
            let across_mm = [aside, -aside].map(|aside| shape.way_out_mm(at_mm, aside));
            let thickness_mm = across_mm[0] + across_mm[1];
            let sides =
                [at_mm + aside * across_mm[0], at_mm - aside * across_mm[1]].map(|side| shape.normal(side));
            // Of what is thicker, nodes feel the one side and the other; at a corner there is no other side.
            if thickness_mm > WALL * edge_mm || sides[0].dot(sides[1]) > OPPOSITE {
                return None;
            }
            let reach_mm = shape.way_out_mm(at_mm, inwards);
            (reach_mm > MOST_OF_THICKNESS * thickness_mm).then_some(PassedThrough {
                at_mm,
                reach_mm,
                thickness_mm,
                edge_mm,
            })
        })
    }

    /// A node that has come to the other side of the shape in a step, if there is one. `before_mm` are the nodes, and `before` is the shape, as they were.
    pub(crate) fn changed_sides(
        &self,
        [before, now]: [&RigidBody; 2],
        boundary: &Boundary,
        [before_mm, now_mm]: [&dyn Fn(u32) -> DVec3; 2],
    ) -> Option<PassedThrough> {
        let nodes = boundary.nodes.iter().zip(&self.touches).zip(&boundary.reach_mm);
        nodes.into_iter().find_map(|((point, touch), &edge_mm)| {
            let [node, ..] = point.corners();
            let at_mm = now_mm(node);
            let from_mm = before.gel_from_shape.inverse_transform_point(before_mm(node));
            let to_mm = now.gel_from_shape.inverse_transform_point(at_mm);
            if touch.bound_mm(to_mm) > from_mm.distance(to_mm) {
                return None;
            }
            let thickness_mm = now.between_mm(from_mm, to_mm)?;
            Some(PassedThrough {
                at_mm,
                reach_mm: thickness_mm,
                thickness_mm,
                edge_mm,
            })
        })
    }
}

impl RigidBody<'_> {
    /// Length of the way from a point inside the shape along a unit vector until it is left, mm; 0 from outside.
    fn way_out_mm(&self, from_mm: DVec3, along: DVec3) -> f64 {
        let from_mm = self.gel_from_shape.inverse_transform_point(from_mm);
        let along = self.gel_from_shape.rotation.inverse() * along;
        let mut way_mm = 0.0;
        for _ in 0..MOST_STEPS {
            let depth_mm = -self.shape.signed_distance(from_mm + along * way_mm).distance_mm;
            if depth_mm < ON_SURFACE_MM {
                break;
            }
            way_mm += depth_mm;
        }
        way_mm
    }

    /// How thick the shape is between two points in its frame that are on opposite sides of it, mm; none if they are not.
    fn between_mm(&self, from_mm: DVec3, to_mm: DVec3) -> Option<f64> {
        let [from, to] = [from_mm, to_mm].map(|at_mm| self.shape.signed_distance(at_mm));
        let way_mm = from_mm.distance(to_mm);
        if from.gradient.dot(to.gradient) > OPPOSITE || from.distance_mm + to.distance_mm > way_mm {
            return None;
        }
        let along = (to_mm - from_mm) / way_mm;
        let entered_mm = self.way_up_to_mm(from_mm, along, way_mm)?;
        let left_mm = self.way_up_to_mm(to_mm, -along, way_mm)?;
        let normal = |at_mm: DVec3| self.shape.signed_distance(at_mm).gradient;
        let [entered, left] = [
            normal(from_mm + along * entered_mm),
            normal(to_mm - along * left_mm),
        ];
        let thickness_mm = way_mm - entered_mm - left_mm;
        (entered.dot(left) < OPPOSITE && thickness_mm > ON_SURFACE_MM).then_some(thickness_mm)
    }

    /// Length of the way from a point along a unit vector up to the shape, mm; none if the shape is not met within so far.
    fn way_up_to_mm(&self, from_mm: DVec3, along: DVec3, most_mm: f64) -> Option<f64> {
        let mut way_mm = 0.0;
        for _ in 0..MOST_STEPS {
            let distance_mm = self.shape.signed_distance(from_mm + along * way_mm).distance_mm;
            if distance_mm < ON_SURFACE_MM {
                return Some(way_mm);
            }
            way_mm += distance_mm;
            if way_mm > most_mm {
                return None;
            }
        }
        None
    }
}
