//! Quadratic displacements (Taylor and Hood, Comput. Fluids 1, 1973: P2/P1), with the four points that integrate quadratic functions
//! exactly. More accurate than linear ones on the same nodes, and dearer.

use super::NODES;
use super::table::{Place, Table, ends};

/// Coordinate of a point along the corner it is nearest to; the others share the rest.
const NEAR: f64 = 0.585_410_196_624_968_5;

/// The table of any coarse tetrahedron.
pub(super) fn table() -> Table {
    Table::new((0..4).map(place).collect())
}

fn place(nearest: usize) -> Place {
    let mut coordinates = [(1.0 - NEAR) / 3.0; 4];
    coordinates[nearest] = NEAR;
    // Slopes in the four coordinates; along an edge from the first corner one rises as the first falls.
    let slopes = |node: u8| {
        let mut in_each = [0.0; 4];
        let [a, b] = ends(node).map(usize::from);
        if a == b {
            in_each[a] = 4.0 * coordinates[a] - 1.0;
        } else {
            in_each[a] = 4.0 * coordinates[b];
            in_each[b] = 4.0 * coordinates[a];
        }
        [1, 2, 3].map(|k| in_each[k] - in_each[0])
    };
    Place {
        nodes: (0..NODES as u8).collect(),
        pairs: Vec::new(),
        slopes: (1..NODES as u8).map(slopes).collect(),
        weights: coordinates,
        volume: 0.25,
    }
}
