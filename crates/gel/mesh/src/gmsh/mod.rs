//! Gmsh's `.msh` files, as written by Gmsh and fTetWild.
//!
//! Versions 2.2 and 4.1 are read, as text and as binary of either byte order. Tetrahedra and the
//! nodes that they use are kept; of tetrahedra with ten nodes or more, only the corners are. They
//! must form one mesh without overlaps. Formats: Gmsh reference manual, section "MSH file format"
//! (4.1) and "Legacy formats" (2.2).

mod assemble;
mod elements;
mod input;
mod read;
mod whole;
mod write;

pub use read::read;
pub use write::write;

/// Name of the node data that state which nodes are bonded (1) and which are not (0).
const BONDED: &str = "bonded";
