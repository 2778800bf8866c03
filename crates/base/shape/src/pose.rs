//! Position and orientation of a rigid body.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// A rigid transform, named `a_from_b` if it takes points given in frame `b` to frame `a`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Origin of the inner frame in the outer frame, mm.
    pub position_mm: DVec3,
    /// Rotation from the inner to the outer frame, a unit quaternion `[x, y, z, w]`.
    #[serde(default)]
    pub rotation: DQuat,
}

impl Default for Pose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Pose {
    /// The identity transform.
    pub const IDENTITY: Self = Self {
        position_mm: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
    };

    /// A pose without rotation.
    #[must_use]
    pub fn from_position(position_mm: DVec3) -> Self {
        Self {
            position_mm,
            rotation: DQuat::IDENTITY,
        }
    }

    /// The composition of poses: an object that has the pose `inner` in the inner frame has the
    /// result as its pose in the outer frame.
    #[must_use]
    pub fn of(&self, inner: &Self) -> Self {
        Self {
            position_mm: self.transform_point(inner.position_mm),
            rotation: (self.rotation * inner.rotation).normalize(),
        }
    }

    /// Transforms a point from the inner to the outer frame, mm.
    #[must_use]
    #[inline]
    pub fn transform_point(&self, point_mm: DVec3) -> DVec3 {
        self.rotation * point_mm + self.position_mm
    }

    /// Transforms a point from the outer to the inner frame, mm.
    #[must_use]
    #[inline]
    pub fn inverse_transform_point(&self, point_mm: DVec3) -> DVec3 {
        self.rotation.inverse() * (point_mm - self.position_mm)
    }
}
