//! What tells distances.

use glam::Vec3A;

/// How far around a shape its distance is told, mm: what is further away does not press.
pub(crate) const REACH_MM: f32 = 2.0;

/// What tells distances.
pub(crate) trait Field {
    /// The distance of a point in the body's frame, mm; [`REACH_MM`] or more where it is more than that.
    fn distance_mm(&self, point: Vec3A) -> f32;
}
