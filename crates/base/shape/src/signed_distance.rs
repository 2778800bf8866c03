//! The interface between shapes and the code for contact and meshing.

use glam::DVec3;

use crate::Pose;

/// Signed distance of a point from a surface, with its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Distance to the surface, mm; negative inside.
    pub distance_mm: f64,
    /// Outward unit gradient of the distance.
    pub gradient: DVec3,
}

/// A closed shape that is given by its signed distance.
pub trait SignedDistance: Send + Sync {
    /// Distance and outward gradient at a point given in the shape's own frame, mm.
    fn signed_distance(&self, point_mm: DVec3) -> Distance;

    /// Smallest box that contains the shape, as (minimum, maximum) corners in the shape's own
    /// frame, mm.
    fn bounds_mm(&self) -> (DVec3, DVec3);

    /// The bodies of a union, each with its pose in the shape's frame; empty if the shape is one
    /// body. In the corner between two bodies the direction of the nearest one jumps. Contact that
    /// treats each body separately finds both.
    fn parts(&self) -> Vec<(Pose, &dyn SignedDistance)> {
        Vec::new()
    }
}
