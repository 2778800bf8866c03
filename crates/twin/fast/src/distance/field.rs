//! The trait of everything that gives distances.

use glam::Vec3A;

/// Distance around a shape up to which distances are exact, mm: a body that is farther away does
/// not press.
pub(crate) const REACH_MM: f32 = 2.0;

/// A signed distance field.
pub(crate) trait Field {
    /// Signed distance of a point in the body's frame, mm; [`REACH_MM`] or more where it is larger
    /// than that.
    fn distance_mm(&self, point: Vec3A) -> f32;
}
