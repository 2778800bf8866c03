//! How the points of a coarse tetrahedron lie among its ten nodes: all that tells one element from another.

/// Corners that the midpoints lie between, in the order of the nodes after the corners.
pub(crate) const EDGES: [[u8; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The points of an element.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    pub(crate) places: Vec<Place>,
    /// Pairs of nodes, the later first, that some point feels together.
    pub(crate) pairs: Vec<[u8; 2]>,
}

/// Where a point is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Place {
    /// The nodes that it feels, ascending.
    pub(crate) nodes: Vec<u8>,
    /// The pairs of these, at `a (a + 1) / 2 + b`, in the element's.
    pub(crate) pairs: Vec<u8>,
    /// Slopes of the shape functions of all of these but the first along the edges from the first corner to the others.
    pub(crate) slopes: Vec<[f64; 3]>,
    /// The shares of the corners' pressures in its own.
    pub(crate) weights: [f64; 4],
    /// Its share of the volume.
    pub(crate) volume: f64,
}

impl Table {
    /// Finds the pairs of nodes of places that do not know theirs yet.
    pub(super) fn new(mut places: Vec<Place>) -> Self {
        let mut pairs: Vec<[u8; 2]> = Vec::new();
        for place in &mut places {
            for (i, &a) in place.nodes.iter().enumerate() {
                for &b in &place.nodes[..=i] {
                    let known = pairs.iter().position(|pair| *pair == [a, b]);
                    place.pairs.push(known.unwrap_or(pairs.len()) as u8);
                    if known.is_none() {
                        pairs.push([a, b]);
                    }
                }
            }
        }
        Self { places, pairs }
    }

    pub(crate) fn same_as(&self, other: &Self) -> bool {
        self.places == other.places
    }
}

/// The corners that a node lies between; a corner twice itself.
pub(crate) fn ends(node: u8) -> [u8; 2] {
    match node.checked_sub(4) {
        Some(edge) => EDGES[edge as usize],
        None => [node; 2],
    }
}
