//! A rigid shape at a pose.

use glam::{DMat3, DVec3};
use twintac_shape::{Pose, SignedDistance};

/// A rigid shape at its present pose.
pub(crate) struct RigidBody<'a> {
    pub(crate) shape: &'a dyn SignedDistance,
    pub(crate) gel_from_shape: Pose,
}

/// Largest number of parts that are treated separately: each of them costs about as much as the
/// first.
const MOST_PARTS: usize = 8;

impl<'a> RigidBody<'a> {
    /// The parts of a shape at a pose; the shape itself if it has no parts, or too many.
    pub(crate) fn parts(shape: &'a dyn SignedDistance, gel_from_shape: Pose) -> Vec<Self> {
        let parts = shape.parts();
        if parts.is_empty() || parts.len() > MOST_PARTS {
            return vec![Self {
                shape,
                gel_from_shape,
            }];
        }
        let placed = parts.into_iter().map(|(whole_from_part, shape)| Self {
            shape,
            gel_from_shape: gel_from_shape.of(&whole_from_part),
        });
        placed.collect()
    }
}

/// `a⊗b`
pub(super) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
