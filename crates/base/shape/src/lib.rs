//! Rigid and gel shapes: signed distances, triangle surfaces, poses.
//!
//! Lengths are in mm. A signed distance is negative inside. An indenter's own frame has its origin at the
//! point of the indenter that touches a flat gel first, and z pointing up, away from the gel: the untilted
//! sphere of radius `r` has its centre at `(0, 0, r)`.

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
