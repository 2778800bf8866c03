//! The quadrature points of a coarse tetrahedron and the shape functions at them: all that differs between elements.

/// Nodes of a coarse tetrahedron: corners and midpoints.
pub(crate) const NODES: usize = 10;

/// Largest number of quadrature points of an element.
pub(super) const MAX_POINTS: usize = 8;

/// The two corners that each midpoint lies between. Midpoints are numbered after the four corners.
pub(crate) const EDGES: [[u8; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The quadrature points of an element.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    pub(crate) points: Vec<QuadraturePoint>,
    /// Pairs of nodes, the later first, that contribute to the same point.
    pub(crate) pairs: Vec<[u8; 2]>,
}

/// A quadrature point: where it lies among the nodes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct QuadraturePoint {
    /// The nodes whose shape functions are not zero there, ascending.
    pub(crate) nodes: Vec<u8>,
    /// Indices of the pairs of these nodes in [`Table::pairs`], at `a (a + 1) / 2 + b`.
    pub(crate) pairs: Vec<u8>,
    /// Slopes of the shape functions of these nodes, without the first, along the three edges at the first corner.
    pub(crate) slopes: Vec<[f64; 3]>,
    /// Weights of the four corners' pressures in the pressure here.
    pub(crate) weights: [f64; 4],
    /// Its share of the element's volume.
    pub(crate) volume: f64,
}

impl Table {
    /// Finds the pairs of nodes of points whose `pairs` are still empty.
    pub(super) fn new(mut points: Vec<QuadraturePoint>) -> Self {
        let mut pairs: Vec<[u8; 2]> = Vec::new();
        for point in &mut points {
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
        Self { points, pairs }
    }

    pub(crate) fn same_as(&self, other: &Self) -> bool {
        self.points == other.points
    }
}

/// The two corners that a node lies between; for a corner, twice itself.
pub(crate) fn ends(node: u8) -> [u8; 2] {
    match node.checked_sub(4) {
        Some(edge) => EDGES[edge as usize],
        None => [node; 2],
    }
}
