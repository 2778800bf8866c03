//! Gmsh's `.msh` files, as Gmsh and fTetWild write them.
//!
//! Versions 2.2 and 4.1 are read, as text and as binary of either byte order. Tetrahedra (of those with ten nodes or more the corners) and the
//! nodes that they use are kept; they have to be one mesh without overlaps. Formats: Gmsh reference manual, section "MSH file format" (4.1) and "Legacy formats" (2.2).

mod assemble;
mod elements;
mod input;
mod read;
mod whole;
mod write;

pub use read::read;
pub use write::write;

/// Name of the node data that tells bonded nodes (1) from others (0).
const BONDED: &str = "bonded";
