//! The composite element P1-iso-P2/P1 (Bercovier and Pironneau, Numer. Math. 33, 1979):
//! displacements are linear on each of the eight tetrahedra that a coarse one is cut into, with one
//! quadrature point each. It is cheap, and its tetrahedra seldom become inverted.

use glam::{DMat3, DVec3};

use super::table::{NODES, QuadraturePoint, Table, ends};

/// The table of a coarse tetrahedron with these ten nodes, which is cut into these eight
/// tetrahedra.
pub(super) fn table(nodes: &[u32; NODES], children: &[[u32; 4]; 8]) -> Table {
    Table::new(points(nodes, children).collect(), Vec::new())
}

/// The quadrature points of that table.
pub(super) fn points(
    nodes: &[u32; NODES],
    children: &[[u32; 4]; 8],
) -> impl Iterator<Item = QuadraturePoint> {
    children.iter().map(|child| point(nodes, child))
}

fn point(nodes: &[u32; NODES], child: &[u32; 4]) -> QuadraturePoint {
    let place = |node| nodes.iter().position(|&other| other == node);
    let mut own = child.map(|node| place(node).expect("children have nodes of their parent alone") as u8);
    own.sort_unstable();
    // Coordinates along the three edges at the first corner: 0 or 1 for corners, and the mean of
    // two corners for midpoints.
    let at = |node: u8| {
        let along = |corner: u8| DVec3::from_array([1, 2, 3].map(|k| f64::from(u8::from(corner == k))));
        let [a, b] = ends(node);
        0.5 * (along(a) + along(b))
    };
    let edges = [1, 2, 3].map(|other: usize| at(own[other]) - at(own[0]));
    let inverse = DMat3::from_cols(edges[0], edges[1], edges[2]).inverse();
    // The pressure is linear. At the centre it is the mean of the pressures of the four nodes; the
    // pressure of a midpoint is the mean of that of two corners.
    let mut weights = [0.0; 4];
    for node in own {
        for end in ends(node) {
            weights[end as usize] += 0.125;
        }
    }
    QuadraturePoint {
        nodes: own.to_vec(),
        pairs: Vec::new(),
        slopes: [0, 1, 2].map(|other| inverse.row(other).to_array()).to_vec(),
        weights,
        volume: 0.125,
    }
}
