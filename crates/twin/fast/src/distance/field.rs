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

    /// Whether the middle of a body that is continued upward is below a point.
    #[inline(always)]
    fn is_below(&self, _point: Vec3A) -> bool {
        false
    }
}
