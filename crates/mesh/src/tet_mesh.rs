//! The mesh itself.

use glam::DVec3;

/// Linear tetrahedra with positive volume: for each, `(b - a) × (c - a) · (d - a) > 0`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TetMesh {
    /// Node positions at rest, mm.
    pub nodes_mm: Vec<DVec3>,
    /// Node indices of each tetrahedron.
    pub tets: Vec<[u32; 4]>,
    /// Which nodes lie where.
    pub sets: NodeSets,
}

/// Named sets of nodes, each sorted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodeSets {
    /// Nodes glued to something rigid: the board at z = 0 and the faces of inclusions.
    pub bonded: Vec<u32>,
    /// Boundary nodes that are not bonded.
    pub free: Vec<u32>,
    /// Free nodes on the surface that is pressed.
    pub top: Vec<u32>,
}
