//! Gmsh's kinds of elements.

/// Kind of a tetrahedron with 4 nodes.
pub(super) const TET_4: i64 = 4;

/// Kind of a tetrahedron with 10 nodes, the corners first.
pub(super) const TET_10: i64 = 11;

/// Nodes of each kind of element, from kind 1 on (Gmsh reference manual, "MSH file format").
const NODES: [usize; 31] = [
    2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5, 6, 20, 35,
    56,
];

/// Nodes of a kind of element; none for a kind that is not known.
pub(super) fn nodes_of(kind: i64) -> Option<usize> {
    let index = usize::try_from(kind).ok()?.checked_sub(1)?;
    NODES.get(index).copied()
}
