//! Checks whether gel and shape have passed through each other, which no solution may have, however
//! small its residual is.
//!
//! A point of the boundary only knows the nearest face of a shape. A wall that is thinner than a
//! step goes past a node from one side to the other. One that is thinner than a triangle goes
//! through between its corners. In both cases the forces balance, so it has to be checked
//! afterwards.

use glam::DVec3;

use super::boundary::Boundary;
use super::rigid_body::RigidBody;
use super::state::Contact;

/// A shape is a wall where it is thinner than this fraction of the longest edge of the triangle
/// that it goes through.
const WALL: f64 = 0.5;

/// Largest reach of a wall through a triangle, as a fraction of its thickness.
const MOST_OF_THICKNESS: f64 = 0.6;

/// If the cosine of the angle between the outward normals at both ends of a path is below this, the
/// ends are on opposite sides of a shape.
const OPPOSITE: f64 = -0.5;

/// A shape pulls at a node, instead of pressing it, if the cosine of the angle between its outward
/// normal and those of all triangles around the node is above this. Where it presses, cosines are
/// near -1; at edges of a body, some of them can be above 0.
const PULLS: f64 = 0.5;

/// A point with a smaller depth than this is on the surface, mm.
const ON_SURFACE_MM: f64 = 1e-3;

/// Largest number of steps of a path through a shape, or up to it.
const MOST_STEPS: u32 = 64;

/// A point at which gel and shape have passed through each other.
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

/// A node of the body's surface that a shape would pull at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pulled {
    pub(crate) at_mm: DVec3,
    /// Longest edge of the boundary's triangles there, mm.
    pub(crate) edge_mm: f64,
}

impl Contact {
    /// A triangle through which a wall of the shape goes; `None` if there is no such triangle.
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
            // On a thicker shape, nodes are in contact with one side and with the other. At a
            // corner there is no other side.
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

    /// A node that the shape would pull at: its normal points along the outward normals of all
    /// triangles around the node, instead of against them. The body has slipped around the shape,
    /// and the nearest way out is on the far side. `None` if there is no such node.
    pub(crate) fn pulled(&self, boundary: &Boundary, node_mm: &dyn Fn(u32) -> DVec3) -> Option<Pulled> {
        let is_touched = |corner: usize| self.touches[corner].force_n > 0.0;
        // The smallest cosine of the angle between the normals, at each node.
        let mut cosines = vec![f64::INFINITY; self.touches.len()];
        for triangle in &boundary.triangles {
            if !triangle.free_corners().any(is_touched) {
                continue;
            }
            let [a, b, c] = triangle.nodes.map(node_mm);
            let outwards = (b - a).cross(c - a).normalize_or_zero();
            for corner in triangle.free_corners() {
                cosines[corner] = cosines[corner].min(self.touches[corner].normal.dot(outwards));
            }
        }
        let pulled = (0..cosines.len()).find(|&node| is_touched(node) && cosines[node] > PULLS)?;
        Some(Pulled {
            at_mm: node_mm(boundary.nodes[pulled].corners()[0]),
            edge_mm: boundary.reach_mm[pulled],
        })
    }

    /// A node that has come to the other side of the shape during a step; `None` if there is no
    /// such node. `before_mm` gives the nodes, and `before` the shape, at the start of the step.
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
    /// Length of the path along a unit vector from a point inside of the shape to its surface, mm;
    /// 0 from outside.
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

    /// Thickness of the shape between two points in its frame on opposite sides of it, mm; `None`
    /// if they are not on opposite sides.
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

    /// Length of the path along a unit vector from a point to the shape, mm; `None` if it is more
    /// than `most_mm`.
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
