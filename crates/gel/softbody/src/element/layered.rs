//! The element at bonded nodes: composite, with quadratic displacements along the edges that start
//! at a bonded corner.
//!
//! Stresses change fastest in the layer of gel that is bonded, because it is sheared there but
//! cannot move. With linear displacements in this layer, pressures at the bonded surface are
//! several percent off on a mesh that is pressed in real time (`tests/pressed_gel.rs` compares
//! both).
//!
//! Displacements are those that are linear between the corners, and for each edge the deviation of
//! its midpoint times a function. For a composite element, that function is linear in each of the
//! eight parts of the tetrahedron. Here it is `4 λ_a λ_b` for an edge between `a` and `b` with a
//! bonded end. All tetrahedra at such an edge have the bonded corner, so that they agree, and faces
//! towards composite elements have no such edge: displacements are continuous.
//!
//! Such displacements may fold between quadrature points where an indenter comes close to the
//! board. A small part of the energy is that of the composite element, which resists that.
//!
//! With all corners treated as bonded, this is the blended element. Beside rims it would fold
//! nevertheless, and has a barrier ([`super::folding`]).

use super::table::{EDGES, NODES, QuadraturePoint, ends};
use super::{composite, quadratic};

/// Part of the composite element in the energy. Without it, deep random presses end inside out
/// (`cargo xtask verify robustness`).
pub(crate) const FLAT_SHARE: f64 = 0.15;

/// Distance of a quadrature point from the middle of the tetrahedron, over that of the middle of
/// its part. The mean square deviation of a barycentric coordinate from 1/4 is then that over the
/// tetrahedron, 3/80, as integrals of squares of linear functions need it. Over the middles of the
/// parts it is 7/256.
const OUTWARDS: f64 = 1.171_080;

/// The quadrature points of a coarse tetrahedron with these ten nodes, which is cut into these
/// eight tetrahedra, and of whose corners these are bonded.
pub(super) fn points(
    nodes: &[u32; NODES],
    children: &[[u32; 4]; 8],
    is_bonded: [bool; 4],
) -> Vec<QuadraturePoint> {
    let share = |share: f64| {
        move |point: QuadraturePoint| QuadraturePoint {
            volume: share * point.volume,
            ..point
        }
    };
    let flat = composite::points(nodes, children).map(share(FLAT_SHARE));
    let is_quadratic = |edge: &[u8; 2]| edge.iter().any(|&corner| is_bonded[corner as usize]);
    let bent: Vec<QuadraturePoint> = if EDGES.iter().all(is_quadratic) {
        quadratic::points().collect()
    } else {
        let points = composite::points(nodes, children);
        points.map(|point| bent(&point, is_quadratic)).collect()
    };
    flat.chain(bent.into_iter().map(share(1.0 - FLAT_SHARE)))
        .collect()
}

/// A composite element's point, with quadratic functions of some edges in place of linear ones.
fn bent(composite: &QuadraturePoint, is_quadratic: impl Fn(&[u8; 2]) -> bool) -> QuadraturePoint {
    let coordinates = composite.weights.map(|weight| 0.25 + OUTWARDS * (weight - 0.25));
    let mut slopes = [[0.0; 3]; NODES];
    let [first, others @ ..] = &composite.nodes[..] else {
        unreachable!("a composite element's points have four nodes");
    };
    for (node, along) in others.iter().zip(&composite.slopes) {
        add(&mut slopes[*node as usize], 1.0, along);
        add(&mut slopes[*first as usize], -1.0, along);
    }
    for (edge, corners) in EDGES.iter().enumerate() {
        let [a, b] = corners.map(usize::from);
        if is_quadratic(corners) {
            // Derivatives along the edges from the first corner, whose coordinate falls there.
            let by = |corner: usize| match corner {
                _ if corner == a => 4.0 * coordinates[b],
                _ if corner == b => 4.0 * coordinates[a],
                _ => 0.0,
            };
            let mut change = [1, 2, 3].map(|corner| by(corner) - by(0));
            add(&mut change, -1.0, &slopes[4 + edge]);
            add(&mut slopes[4 + edge], 1.0, &change);
            for end in ends(4 + edge as u8) {
                add(&mut slopes[end as usize], -0.5, &change);
            }
        }
    }
    let used: Vec<u8> = (0..NODES as u8)
        .filter(|&node| slopes[node as usize] != [0.0; 3])
        .collect();
    QuadraturePoint {
        slopes: used[1..].iter().map(|&node| slopes[node as usize]).collect(),
        nodes: used,
        pairs: Vec::new(),
        ..*composite
    }
}

/// `sum += times other`
fn add(sum: &mut [f64; 3], times: f64, other: &[f64; 3]) {
    for (sum, other) in sum.iter_mut().zip(other) {
        *sum += times * other;
    }
}
