//! Element types of Gmsh.

/// Type number of a tetrahedron with 4 nodes.
pub(super) const TET_4: i64 = 4;

/// Number of nodes of each element type, from type 1 on (Gmsh reference manual, "MSH file format").
const NODES: [usize; 31] = [
    2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5, 6, 20, 35,
    56,
];

/// Number of nodes of an element type; `None` for an unknown type.
pub(super) fn nodes_of(kind: i64) -> Option<usize> {
    let index = usize::try_from(kind).ok()?.checked_sub(1)?;
    NODES.get(index).copied()
}

/// The role of an element type in a mesh of a gel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Use {
    /// A tetrahedron, its four corners first.
    Tetrahedron,
    /// A point, a line or a face: it has no volume.
    NoVolume,
    /// A solid of another shape, with its name.
    Other(&'static str),
}

pub(super) fn use_of(kind: i64) -> Use {
    match kind {
        TET_4 | 11 | 29 | 30 | 31 => Use::Tetrahedron,
        5 | 12 | 17 => Use::Other("a hexahedron"),
        6 | 13 | 18 => Use::Other("a prism"),
        7 | 14 | 19 => Use::Other("a pyramid"),
        _ => Use::NoVolume,
    }
}
