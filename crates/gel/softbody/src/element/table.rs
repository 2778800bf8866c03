//! The quadrature points of a coarse tetrahedron, and the shape functions at these points:
//! everything in which elements differ.

/// Number of nodes of a coarse tetrahedron: corners and midpoints.
pub(crate) const NODES: usize = 10;

/// Largest number of quadrature points of an element.
pub(super) const MAX_POINTS: usize = 16;

/// The two corners of the edge of each midpoint. Midpoints are numbered after the four corners.
pub(crate) const EDGES: [[u8; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The quadrature points of an element.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    pub(crate) points: Vec<QuadraturePoint>,
    /// Points at which a barrier resists folding; they have no part in the quadrature.
    pub(super) guards: Vec<QuadraturePoint>,
    /// Pairs of nodes that contribute to the same point, later node first.
    pub(crate) pairs: Vec<[u8; 2]>,
}

/// A quadrature point, given by its position relative to the nodes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct QuadraturePoint {
    /// The nodes whose shape functions are nonzero at the point, ascending.
    pub(crate) nodes: Vec<u8>,
    /// Indices of the pairs of these nodes in [`Table::pairs`], at `a (a + 1) / 2 + b`.
    pub(crate) pairs: Vec<u8>,
    /// Derivatives of the shape functions of these nodes, except for the first, along the three
    /// edges at the first corner.
    pub(crate) slopes: Vec<[f64; 3]>,
    /// Weights of the pressures of the four corners in the pressure at this point.
    pub(crate) weights: [f64; 4],
    /// Fraction of the element's volume.
    pub(crate) volume: f64,
}

impl Table {
    /// Finds the pairs of nodes of points and guards whose `pairs` are still empty.
    pub(super) fn new(mut points: Vec<QuadraturePoint>, mut guards: Vec<QuadraturePoint>) -> Self {
        let mut pairs: Vec<[u8; 2]> = Vec::new();
        for point in points.iter_mut().chain(&mut guards) {
            for (i, &a) in point.nodes.iter().enumerate() {
                for &b in &point.nodes[..=i] {
                    let known = pairs.iter().position(|pair| *pair == [a, b]);
                    point.pairs.push(known.unwrap_or(pairs.len()) as u8);
                    if known.is_none() {
                        pairs.push([a, b]);
                    }
                }
            }
        }
        Self {
            points,
            guards,
            pairs,
        }
    }

    pub(crate) fn same_as(&self, other: &Self) -> bool {
        self.points == other.points && self.guards == other.guards
    }
}

/// The two corners of the edge whose midpoint is this node; for a corner, twice itself.
pub(crate) fn ends(node: u8) -> [u8; 2] {
    match node.checked_sub(4) {
        Some(edge) => EDGES[edge as usize],
        None => [node; 2],
    }
}
