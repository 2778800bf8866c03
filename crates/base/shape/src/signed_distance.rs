//! What contact and meshing ask of a shape.

use glam::DVec3;

use crate::Pose;

/// Signed distance of a point to a surface, with its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Distance to the surface, mm; negative inside.
    pub distance_mm: f64,
    /// Outward unit gradient of the distance.
    pub gradient: DVec3,
}

/// A closed shape known by its signed distance.
pub trait SignedDistance: Send + Sync {
    /// Distance and outward gradient at a point given in the shape's own frame, mm.
    fn signed_distance(&self, point_mm: DVec3) -> Distance;

    /// Smallest box, as (minimum, maximum) corners in the shape's own frame, that holds the shape, mm.
    fn bounds_mm(&self) -> (DVec3, DVec3);

    /// The bodies that the shape is united of, each with its pose in the shape's frame; empty where it is one body. In the corner between two of them the direction of the
    /// nearest one jumps: contact that treats each by itself finds both.
    fn parts(&self) -> Vec<(Pose, &dyn SignedDistance)> {
        Vec::new()
    }
}
