//! Tetrahedral meshes: generated from a solid, imported from Gmsh, exported to VTK and STL. Lengths in mm.

mod tet_mesh;

pub use tet_mesh::{NodeSets, TetMesh};
