//! Tetrahedral meshes: generated from a solid, imported from Gmsh, exported to VTK and STL. Lengths in mm.

mod axis;
mod boundary;
mod error;
mod footprint;
mod generate;
pub mod gmsh;
mod grid;
mod lattice;
mod locate;
mod quality;
mod region;
mod settings;
mod size;
mod stencil;
pub mod stl;
mod stuffing;
mod tet_mesh;
mod volume;
pub mod vtk;

pub use error::MeshError;
pub use generate::{generate, generate_with_node_count};
pub use quality::{Quality, Spread};
pub use settings::{Cuboid, Focus, MeshSettings};
pub use tet_mesh::{NodeSets, TetMesh};
pub use volume::gel_volume_mm3;
