//! Which faces of a body are its tops. The region above a top is treated as if the body continued
//! there.

use glam::Vec3A;

/// Upward component of the normal from which a face of a thin body begins to count as a top, and
/// from which it counts fully.
const LOOKS_UP: [f32; 2] = [0.1, 0.3];

/// By how much more the face of a thick body has to look up: training presses contain leaning
/// boxes, and their sides are not tops.
const MORE: f32 = 0.4;

/// Thickness of a thin body and of a thick one, mm: the boxes of the training presses are at least
/// 3.5 mm wide.
const THIN_MM: f32 = 2.5;
const THICK_MM: f32 = 3.5;

/// The upward direction in a body's frame: the gel is never above a body that came from outside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Upward {
    /// Outward normal of the gel in the body's frame.
    pub(super) direction: Vec3A,
}

impl Upward {
    pub(crate) fn new(direction: Vec3A) -> Self {
        Self { direction }
    }

    /// Degree to which the faces across each axis are tops, from 0 to 1, with the sign of the face
    /// that is one. `thick_mm`: thickness of the body along each axis, mm.
    pub(super) fn tops(self, thick_mm: Vec3A) -> Vec3A {
        let (height, thick_mm) = (self.direction.to_array(), thick_mm.to_array());
        Vec3A::from_array(
            [0, 1, 2].map(|axis| top(height[axis].abs(), thick_mm[axis]).copysign(height[axis])),
        )
    }
}

/// Degree to which a face is a top, from 0 to 1. `height`: upward component of its normal;
/// `thick_mm`: thickness of the body under it, mm.
pub(super) fn top(height: f32, thick_mm: f32) -> f32 {
    let thick = ((thick_mm - THIN_MM) / (THICK_MM - THIN_MM)).clamp(0.0, 1.0);
    let [side, top] = LOOKS_UP.map(|height| height + MORE * thick);
    let part = ((height - side) / (top - side)).clamp(0.0, 1.0);
    part * part * (3.0 - 2.0 * part)
}
