//! A rigid shape at a pose.

use glam::{DMat3, DVec3};
use twintac_shape::{Pose, SignedDistance};

/// A rigid shape at its present pose.
pub(crate) struct RigidBody<'a> {
    pub(crate) shape: &'a dyn SignedDistance,
    pub(crate) gel_from_shape: Pose,
}

/// `a⊗b`
pub(super) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
