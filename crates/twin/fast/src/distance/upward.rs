//! Which faces of a body are its top: what is above them is as deep in the body as in one that goes on.

use glam::Vec3A;

/// How steeply the face of a thin body looks up, as the height of its normal, to be a top in part, and as a whole.
const LOOKS_UP: [f32; 2] = [0.1, 0.3];

/// By how much more that of a thick one has to: boxes that were taught lean, and their sides are none.
const MORE: f32 = 0.4;

/// What is thin and thick, mm: boxes that were taught are 3.5 mm wide at least.
const THIN_MM: f32 = 2.5;
const THICK_MM: f32 = 3.5;

/// What is up, as a body sees it: gels are never above a body that came from outside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Upward {
    /// The gel's outward normal in the body's frame.
    pub(super) direction: Vec3A,
}

impl Upward {
    pub(crate) fn new(direction: Vec3A) -> Self {
        Self { direction }
    }

    /// How far faces across each axis are tops, from 0 to 1, with the sign of the one that is, of a body this thick along each, mm.
    pub(super) fn tops(self, thick_mm: Vec3A) -> Vec3A {
        let (height, thick_mm) = (self.direction.to_array(), thick_mm.to_array());
        Vec3A::from_array(
            [0, 1, 2].map(|axis| top(height[axis].abs(), thick_mm[axis]).copysign(height[axis])),
        )
    }
}

/// How far a face is a top, from 0 to 1, by the height of its normal and how thick the body is under it, mm.
pub(super) fn top(height: f32, thick_mm: f32) -> f32 {
    let thick = ((thick_mm - THIN_MM) / (THICK_MM - THIN_MM)).clamp(0.0, 1.0);
    let [side, top] = LOOKS_UP.map(|height| height + MORE * thick);
    let part = ((height - side) / (top - side)).clamp(0.0, 1.0);
    part * part * (3.0 - 2.0 * part)
}
