//! How often surfaces wind around a point: once in their inside, not at all outside, more often where bodies overlap.

use glam::{DMat3, DVec2, DVec3};

use crate::bvh::Bvh;

/// The direction of rays, which no face of a usual body has.
const RAY: DVec3 = DVec3::new(
    0.301_511_344_577_763_6,
    0.402_911_822_012_345_7,
    0.864_145_372_291_604_2,
);

/// Rays through triangles.
pub(crate) struct Winding {
    /// Two directions across the ray, and the ray's.
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

    /// Winding number of closed surfaces about a point: how much more often a ray from there leaves than enters.
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

/// Whether a triangle is left (1), entered (-1) or missed by a ray from the origin along z.
fn crossing(corners: [DVec3; 3]) -> i32 {
    let [a, b, c] = corners.map(DVec3::truncate);
    let sides = [is_left(a, b), is_left(b, c), is_left(c, a)];
    if sides != [sides[0]; 3] {
        return 0;
    }
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    // Height of the plane over the origin; upright triangles are never crossed.
    if normal.z == 0.0 || corners[0].dot(normal) / normal.z <= 0.0 {
        return 0;
    }
    if sides[0] { 1 } else { -1 }
}

/// Whether the origin is to the left of a line; the other triangle at the same edge gets the opposite answer, whatever rounding does.
fn is_left(from: DVec2, to: DVec2) -> bool {
    if (from.x, from.y) < (to.x, to.y) {
        from.perp_dot(to) >= 0.0
    } else {
        to.perp_dot(from) < 0.0
    }
}
