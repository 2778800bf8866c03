//! The quadratic element P2/P1 (Taylor and Hood, Comput. Fluids 1, 1973), with the four quadrature
//! points that integrate quadratic functions exactly. On the same nodes it is more accurate than
//! the composite element, and more expensive.

use super::table::{NODES, QuadraturePoint, Table, ends};

/// Barycentric coordinate of a quadrature point for its nearest corner; the other three coordinates
/// are equal.
const NEAR: f64 = 0.585_410_196_624_968_5;

/// The table, which is the same for all coarse tetrahedra.
pub(super) fn table() -> Table {
    Table::new(points().collect(), corners().collect())
}

/// The quadrature points of that table.
pub(super) fn points() -> impl Iterator<Item = QuadraturePoint> {
    (0..4).map(|nearest| {
        let mut coordinates = [(1.0 - NEAR) / 3.0; 4];
        coordinates[nearest] = NEAR;
        point(coordinates)
    })
}

/// The corners.
pub(super) fn corners() -> impl Iterator<Item = QuadraturePoint> {
    (0..4).map(|corner| {
        let mut coordinates = [0.0; 4];
        coordinates[corner] = 1.0;
        point(coordinates)
    })
}

/// The point with these barycentric coordinates.
fn point(coordinates: [f64; 4]) -> QuadraturePoint {
    // Derivatives by the four barycentric coordinates. Along an edge from the first corner, one
    // coordinate rises and the first falls.
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
    QuadraturePoint {
        nodes: (0..NODES as u8).collect(),
        pairs: Vec::new(),
        slopes: (1..NODES as u8).map(slopes).collect(),
        weights: coordinates,
        volume: 0.25,
    }
}
