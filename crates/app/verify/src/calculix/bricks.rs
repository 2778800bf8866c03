//! 20-node hexahedra, extruded from a plan.

use std::collections::BTreeMap;

use glam::DVec3;

use super::plan::Plan;

/// A block of 20-node hexahedra. Corners come first, then midpoints of edges: the order of CalculiX
/// and Abaqus.
pub(super) struct Bricks {
    pub(super) nodes_mm: Vec<DVec3>,
    pub(super) bricks: Vec<[usize; 20]>,
    /// Number of hexahedra in one layer. The first ones are the lowest layer, the last ones the
    /// uppermost.
    pub(super) n_layer: usize,
}

impl Bricks {
    /// Extrudes a plan through levels, from the lowest to the highest.
    pub(super) fn extrude(plan: &Plan, levels_mm: &[f64]) -> Self {
        let mut mesh = Self {
            nodes_mm: Vec::new(),
            bricks: Vec::new(),
            n_layer: plan.quads.len(),
        };
        // A node is the midpoint of two corners, which may be the same one.
        let n_points = plan.points_mm.len();
        let mut known = BTreeMap::new();
        let mut node = |a: usize, b: usize| {
            *known.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                let corner_mm =
                    |corner: usize| plan.points_mm[corner % n_points].extend(levels_mm[corner / n_points]);
                mesh.nodes_mm.push(corner_mm(a).midpoint(corner_mm(b)));
                mesh.nodes_mm.len() - 1
            })
        };
        for layer in 0..levels_mm.len() - 1 {
            for quad in &plan.quads {
                let low = quad.map(|point| point + layer * n_points);
                let high = low.map(|corner| corner + n_points);
                let mut brick = [0; 20];
                for i in 0..4 {
                    let next = (i + 1) % 4;
                    brick[i] = node(low[i], low[i]);
                    brick[i + 4] = node(high[i], high[i]);
                    brick[i + 8] = node(low[i], low[next]);
                    brick[i + 12] = node(high[i], high[next]);
                    brick[i + 16] = node(low[i], high[i]);
                }
                mesh.bricks.push(brick);
            }
        }
        mesh
    }

    /// The faces of the lowest layer: four corners, then the midpoints of the edges that follow
    /// them.
    pub(super) fn bottom(&self) -> Vec<[usize; 8]> {
        let face = |brick: &[usize; 20]| std::array::from_fn(|i| brick[if i < 4 { i } else { i + 4 }]);
        self.bricks[..self.n_layer].iter().map(face).collect()
    }
}
