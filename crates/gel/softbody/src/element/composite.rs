//! Linear displacements on the eight tetrahedra that a coarse one is cut into, with one point each (Bercovier and Pironneau, Numer. Math. 33,
//! 1979: P1-iso-P2/P1). Cheap, and hard to turn inside out.

use glam::{DMat3, DVec3};

use super::NODES;
use super::table::{Place, Table, ends};

/// The table of a coarse tetrahedron with these ten nodes, cut into these.
pub(super) fn table(nodes: &[u32; NODES], children: &[[u32; 4]; 8]) -> Table {
    Table::new(children.iter().map(|child| place(nodes, child)).collect())
}

fn place(nodes: &[u32; NODES], child: &[u32; 4]) -> Place {
    let mut felt = child.map(|node| nodes.iter().position(|&other| other == node).unwrap_or_default() as u8);
    felt.sort_unstable();
    // Along the edges of the coarse tetrahedron, corners lie at 0 and 1, midpoints halfway.
    let at = |node: u8| {
        let along = |corner: u8| DVec3::from_array([1, 2, 3].map(|k| f64::from(u8::from(corner == k))));
        let [a, b] = ends(node);
        0.5 * (along(a) + along(b))
    };
    let edges = [1, 2, 3].map(|other: usize| at(felt[other]) - at(felt[0]));
    let inverse = DMat3::from_cols(edges[0], edges[1], edges[2]).inverse();
    // A linear pressure at the centre: the mean of the four nodes', of which midpoints have two corners' mean.
    let mut weights = [0.0; 4];
    for node in felt {
        for end in ends(node) {
            weights[end as usize] += 0.125;
        }
    }
    Place {
        nodes: felt.to_vec(),
        pairs: Vec::new(),
        slopes: [0, 1, 2].map(|other| inverse.row(other).to_array()).to_vec(),
        weights,
        volume: 0.125,
    }
}
