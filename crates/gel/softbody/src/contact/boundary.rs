//! The boundary of a body.

use glam::DVec3;

use super::point::ContactPoint;
use super::triangle::BoundaryTriangle;

/// The boundary of a body: the part that can come into contact.
pub(crate) struct Boundary {
    /// Its free nodes.
    pub(crate) nodes: Vec<ContactPoint>,
    pub(super) triangles: Vec<BoundaryTriangle>,
    /// Longest edge at each of the nodes, mm.
    pub(super) reach_mm: Vec<f64>,
}

impl Boundary {
    pub(crate) fn new(nodes: Vec<ContactPoint>, triangles: Vec<BoundaryTriangle>) -> Self {
        let mut reach_mm = vec![0.0_f64; nodes.len()];
        for triangle in &triangles {
            for corner in triangle.free_corners() {
                reach_mm[corner] = reach_mm[corner].max(triangle.longest_mm);
            }
        }
        Self {
            nodes,
            triangles,
            reach_mm,
        }
    }

    /// Positions of its nodes, mm, given those of all nodes.
    pub(super) fn nodes_mm(&self, node_mm: &dyn Fn(u32) -> DVec3) -> impl Iterator<Item = DVec3> {
        self.nodes.iter().map(move |point| node_mm(point.corners()[0]))
    }
}
