//! Geometry of indenters and gels: signed distances, triangle surfaces, poses.
//!
//! - [`Shape`] is an indenter: a ball, cylinder, box, ring, wedge, an STL surface, or a union of
//!   these. [`Solid`] is a gel: a block, a dome, or an STL surface.
//! - [`SignedDistance`] answers what contact and meshing need to know of a shape: the [`Distance`]
//!   of a point with its direction, and the bounding box.
//! - [`TriangleSurface`] is a closed surface read from the bytes of an STL file, which a
//!   [`SurfaceFile`] names.
//! - [`Pose`] is a rigid transform. [`Underside`] compares the contact geometry of two shapes.
//!
//! Lengths are in mm. A signed distance is negative inside. An indenter's own frame has its origin
//! at the point of the indenter that touches a flat gel first, and z points up, away from the gel:
//! the sphere of radius `r`, not tilted, has its centre at `(0, 0, r)`. A gel stands on the plane
//! z = 0, the circuit board.
//!
//! # How it works
//!
//! Primitive shapes have formulas for their distance; the direction is the gradient. The distance
//! is exact outside of all indenters. A method states where its distance is not exact: next to the
//! corner ridges of a block of gel it is a lower bound, and inside of a union it is that to the
//! nearest surface of one of the parts. A rounded shape is the sharp shape made smaller by the
//! radius and then grown by the radius in all directions.
//!
//! A triangle surface finds the nearest triangle in a tree of bounding boxes (`bvh`). The sign
//! comes from angle-weighted pseudonormals, which give the correct sign for every closed surface.
//!
//! What a surface consists of is found in four steps:
//!
//! - `weld` makes equal corners one vertex, and leaves out triangles without area and duplicates.
//! - `manifold` joins triangles across their edges, and turns those that face another way than
//!   their neighbours.
//! - `nesting` finds which connected surfaces are bodies and which are cavities in them, and turns
//!   them accordingly.
//! - `overlap` searches for surfaces that run through themselves or through other bodies.
//!
//! These steps are code of our own, because users are told which bodies and cavities a file has,
//! and which of its faults were corrected. Libraries that repair meshes do more than is asked, and
//! none reports what it did.
//!
//! The reader of STL files (200 lines) is also our own:
//!
//! - `stl_io` takes a text file for a binary one unless it begins with `solid` and a blank in lower
//!   case and UTF-8. Upper case, a byte order mark, names in Latin-1 and comments end with the
//!   error "failed to fill whole buffer".
//! - It takes a binary file that begins with `solid` for a text file, requires `endsolid` and the
//!   usual lines, names no line in its errors, and rounds texts to single precision.
//! - `tobj` reads OBJ files only.
//!
//! This crate depends on no other crate of the workspace. It knows no meshes and opens no files:
//! callers pass the bytes.

mod block;
mod bvh;
mod dome;
mod extent;
mod filled;
mod manifold;
mod nesting;
mod overlap;
mod pose;
mod prism;
mod profile;
mod shape;
mod shape_error;
mod signed_distance;
mod solid;
mod stl;
mod stl_text;
mod surface;
mod surface_error;
mod surface_file;
mod underside;
mod union;
mod weld;
mod winding;

pub use dome::Dome;
pub use extent::ExtentError;
pub use pose::Pose;
pub use shape::{Part, Shape};
pub use shape_error::ShapeError;
pub use signed_distance::{Distance, SignedDistance};
pub use solid::Solid;
pub use surface::{Surfaces, TriangleSurface};
pub use surface_error::SurfaceError;
pub use surface_file::{LengthUnit, SurfaceFile};
pub use underside::Underside;
