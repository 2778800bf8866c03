//! The points of the boundary at which contact is evaluated.

use glam::DVec3;

/// A contact point: a node of the boundary, or a quadrature point inside a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactPoint {
    /// Corners of the triangle; for a node, the node itself.
    nodes: [u32; 3],
    /// Weights of the corners; for a node 1, 0 and 0.
    weights: [f64; 3],
    /// Contact stiffness κ, N/mm: a stiffness per area times the boundary area of the point.
    pub(crate) stiffness: f64,
    /// Depth inside of a shape that causes no force, mm.
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

    /// A quadrature point inside a triangle.
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

    /// Corners of the triangle; for a node, three times the node itself.
    pub(super) fn corners(&self) -> [u32; 3] {
        self.nodes
    }

    /// Value of a nodal field at the point.
    #[inline]
    pub(crate) fn value(&self, field: &[DVec3]) -> DVec3 {
        let [a, b, c] = self.nodes.map(|node| node as usize);
        if self.is_node() {
            field[a]
        } else {
            field[a] * self.weights[0] + field[b] * self.weights[1] + field[c] * self.weights[2]
        }
    }

    /// The nodes that the point depends on, and their weights.
    #[inline]
    pub(crate) fn parts(&self) -> impl Iterator<Item = (u32, f64)> + Clone + use<> {
        let n_parts = if self.is_node() { 1 } else { 3 };
        self.nodes.into_iter().zip(self.weights).take(n_parts)
    }
}
