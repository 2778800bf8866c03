//! Where on the boundary contact is asked about.

use glam::DVec3;

use super::BoundaryTriangle;

/// A place on the boundary that can touch: a node, or a place inside a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactPoint {
    /// The triangle's corners; of a node, itself.
    nodes: [u32; 3],
    /// How much of the place each corner is; of a node, all of it.
    weights: [f64; 3],
    /// Contact stiffness κ, N/mm: a stiffness per area times the boundary area that belongs to the place.
    pub(crate) stiffness: f64,
    /// Depth inside a shape that counts for nothing, mm.
    pub(crate) slack_mm: f64,
}

impl ContactPoint {
    /// A node.
    pub(crate) fn of_node(node: u32, stiffness: f64) -> Self {
        Self {
            nodes: [node; 3],
            weights: [1.0, 0.0, 0.0],
            stiffness,
            slack_mm: 0.0,
        }
    }

    /// A place inside a triangle.
    pub(super) fn inside(nodes: [u32; 3], weights: [f64; 3], stiffness: f64, slack_mm: f64) -> Self {
        Self {
            nodes,
            weights,
            stiffness,
            slack_mm,
        }
    }

    /// Whether it is a node.
    pub(super) fn is_node(&self) -> bool {
        self.weights[0] == 1.0
    }

    /// Value of a nodal field.
    #[inline]
    pub(crate) fn value(&self, field: &[DVec3]) -> DVec3 {
        let [a, b, c] = self.nodes.map(|node| node as usize);
        if self.is_node() {
            field[a]
        } else {
            field[a] * self.weights[0] + field[b] * self.weights[1] + field[c] * self.weights[2]
        }
    }

    /// The nodes that the place hangs on, and how much of it each is.
    #[inline]
    pub(crate) fn parts(&self) -> impl Iterator<Item = (u32, f64)> + Clone + use<> {
        let n_parts = if self.is_node() { 1 } else { 3 };
        self.nodes.into_iter().zip(self.weights).take(n_parts)
    }
}

/// The boundary of a body: what can touch.
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
}
