//! Winding numbers of surfaces around a point: 0 outside, 1 inside, more where bodies overlap.

use glam::{DMat3, DVec2, DVec3};

use crate::bvh::Bvh;

/// Direction of the rays, chosen so that no face of a usual body has it.
const RAY: DVec3 = DVec3::new(
    0.301_511_344_577_763_6,
    0.402_911_822_012_345_7,
    0.864_145_372_291_604_2,
);

/// Counts crossings of rays and triangles.
pub(crate) struct Winding {
    /// Two directions across the ray, and the direction of the ray.
    frame: DMat3,
}

impl Winding {
    pub(crate) fn new() -> Self {
        let ray = RAY.normalize();
        let (right, up) = ray.any_orthonormal_pair();
        Self {
            frame: DMat3::from_cols(right, up, ray).transpose(),
        }
    }

    /// Winding number of closed surfaces around a point: how many more times a ray from the point
    /// leaves than enters them.
    pub(crate) fn number(&self, bvh: &Bvh, corners: &dyn Fn(usize) -> [DVec3; 3], point: DVec3) -> i32 {
        let ray = self.frame.row(2);
        let mut number = 0;
        bvh.along(point, ray, &mut |triangle| {
            let corners = corners(triangle).map(|corner| self.frame * (corner - point));
            number += crossing(corners);
        });
        number
    }
}

/// Whether a ray from the origin along z leaves a triangle (1), enters it (-1) or misses it (0).
fn crossing(corners: [DVec3; 3]) -> i32 {
    let [a, b, c] = corners.map(DVec3::truncate);
    let sides = [is_left(a, b), is_left(b, c), is_left(c, a)];
    if sides != [sides[0]; 3] {
        return 0;
    }
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    // Height of the plane above the origin; upright triangles are never crossed.
    if normal.z == 0.0 || corners[0].dot(normal) / normal.z <= 0.0 {
        return 0;
    }
    if sides[0] { 1 } else { -1 }
}

/// Whether the origin is to the left of a line. The other triangle at the same edge always gets the
/// opposite answer, independent of rounding.
fn is_left(from: DVec2, to: DVec2) -> bool {
    if (from.x, from.y) < (to.x, to.y) {
        from.perp_dot(to) >= 0.0
    } else {
        to.perp_dot(from) < 0.0
    }
}
