//! Simple shapes that are continued upward above their tops, by formulas. Below their middles the
//! distances are unchanged.

use glam::{Vec2, Vec3A};

use super::field::Field;
use super::formulas::{Ball, RoundedBox, RoundedCylinder};
use super::upward::{Upward, top};

/// A ball that is continued upward as a cylinder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OpenBall<'a> {
    ball: &'a Ball,
    up: Vec3A,
}

/// A box that is continued upward above its tops.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OpenBox<'a> {
    solid: &'a RoundedBox,
    /// Twice the degree to which the faces across each axis are tops.
    tops: Vec3A,
    /// Outward normal of the top on the axis along which the box is thinnest.
    out: Vec3A,
    /// Outward signs of the faces across each axis that look down.
    down: Vec3A,
    /// Cosine and sine of the angle by which each of those faces leans out over what is below.
    lean: [Vec3A; 2],
}

/// A cylinder that is continued upward above its upper end and, where it lies, above its axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OpenCylinder<'a> {
    solid: &'a RoundedCylinder,
    /// Twice the degree to which the ends are tops.
    end: f32,
    /// Outward direction of the upper end.
    out: f32,
    /// Sideways component of the gel's outward normal for each mm along the axis, scaled by the
    /// degree to which the end is a top.
    lean: Vec2,
    /// The upward direction perpendicular to the axis, and the degree to which the side is a top.
    up: Vec2,
    side: f32,
}

impl Ball {
    pub(crate) fn open(&self, upward: Upward) -> OpenBall<'_> {
        OpenBall {
            ball: self,
            up: upward.direction,
        }
    }
}

impl RoundedBox {
    pub(crate) fn open(&self, upward: Upward) -> OpenBox<'_> {
        let up = upward.direction;
        let tops = upward.tops(2.0 * (self.half_mm + self.edge_radius_mm));
        // Of the axes across which there is a top, the one along which the box is thinnest.
        let axes = [Vec3A::X, Vec3A::Y, Vec3A::Z].into_iter();
        let main = axes
            .filter(|axis| tops.dot(*axis) != 0.0)
            .min_by(|a, b| self.half_mm.dot(*a).total_cmp(&self.half_mm.dot(*b)))
            .unwrap_or(Vec3A::ZERO);
        let height = up.dot(main);
        let others = Vec3A::ONE - main;
        let leans = others * up.abs() * (tops.dot(main) / height.abs().max(f32::MIN_POSITIVE)).abs();
        let cosine = (leans * leans + 1.0).to_array().map(|square| 1.0 / square.sqrt());
        let cosine = Vec3A::from_array(cosine);
        OpenBox {
            solid: self,
            tops: 2.0 * tops,
            out: main * height.signum(),
            down: -up.signum(),
            lean: [cosine, leans * cosine],
        }
    }
}

impl RoundedCylinder {
    pub(crate) fn open(&self, upward: Upward) -> OpenCylinder<'_> {
        let up = upward.direction;
        let thick_mm =
            2.0 * Vec3A::new(self.radius_mm, self.radius_mm, self.half_height_mm) + 2.0 * self.edge_radius_mm;
        let end = upward.tops(thick_mm).z;
        let beside = Vec2::new(up.x, up.y);
        let lean = if end == 0.0 {
            Vec2::ZERO
        } else {
            end.abs() / up.z.abs() * beside
        };
        OpenCylinder {
            solid: self,
            end: 2.0 * end,
            out: up.z.signum(),
            lean,
            up: beside.normalize_or_zero(),
            side: top(beside.length(), thick_mm.x),
        }
    }
}

impl Field for OpenBall<'_> {
    #[inline(always)]
    fn distance_mm(&self, point: Vec3A) -> f32 {
        let from_middle = point - Vec3A::new(0.0, 0.0, self.ball.radius_mm);
        let above = from_middle.dot(self.up).max(0.0);
        (from_middle - above * self.up).length() - self.ball.radius_mm
    }

    #[inline(always)]
    fn is_below(&self, point: Vec3A) -> bool {
        (point - Vec3A::new(0.0, 0.0, self.ball.radius_mm)).dot(self.up) > 0.0
    }
}

impl Field for OpenBox<'_> {
    #[inline(always)]
    fn distance_mm(&self, point: Vec3A) -> f32 {
        let half_mm = self.solid.half_mm;
        let from_middle = point - self.solid.middle_mm;
        let above = (from_middle * self.tops).max(Vec3A::ZERO);
        let beyond = from_middle.abs() - half_mm - above;
        // A face that leans out over the gel ends at the top's height. Above it the side is
        // vertical.
        let over_top = (from_middle - self.out * half_mm).dot(self.out);
        let [cosine, sine] = self.lean;
        let beside = (from_middle * self.down - half_mm) * cosine + over_top * sine;
        self.solid.over_sides_mm(beyond.max(beside))
    }

    #[inline(always)]
    fn is_below(&self, point: Vec3A) -> bool {
        (point - self.solid.middle_mm).dot(self.out) > 0.0
    }
}

impl Field for OpenCylinder<'_> {
    #[inline(always)]
    fn distance_mm(&self, point: Vec3A) -> f32 {
        let beside = Vec2::new(point.x, point.y);
        let beside = beside - self.up * (self.side * beside.dot(self.up).max(0.0));
        let from_middle = point.z - self.solid.middle_mm;
        let above = from_middle.abs() - self.solid.half_height_mm - (from_middle * self.end).max(0.0);
        // Beside a top that leans, the side is vertical.
        let over_top = (from_middle * self.out - self.solid.half_height_mm).max(0.0);
        let aside = beside.length().max((beside - self.lean * over_top).length());
        self.solid.over_sides_mm(aside - self.solid.radius_mm, above)
    }

    #[inline(always)]
    fn is_below(&self, point: Vec3A) -> bool {
        if self.end == 0.0 {
            return self.side * Vec2::new(point.x, point.y).dot(self.up) > 0.0;
        }
        (point.z - self.solid.middle_mm) * self.out > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;

    #[test]
    fn what_is_below_the_middle_has_the_same_bits() {
        let ball = Ball::new(5.0);
        let solid = RoundedBox::new([8.0, 9.0, 10.0], 0.8);
        let cylinder = RoundedCylinder::new(4.0, 10.0, 0.8);
        for step in 0..5000u16 {
            let turn = |rate: f32| (f32::from(step) * rate).fract();
            let tilt = Quat::from_rotation_z(7.0 * turn(0.31)) * Quat::from_rotation_y(0.5 * turn(0.47));
            let upward = Upward::new((tilt * glam::Vec3::Z).into());
            let point = Vec3A::new(
                14.0 * turn(0.618) - 7.0,
                14.0 * turn(0.755) - 7.0,
                4.0 * turn(0.57) - 2.0,
            );
            check(&ball, &ball.open(upward), point);
            check(&solid, &solid.open(upward), point);
            check(&cylinder, &cylinder.open(upward), point);
        }
    }

    fn check(plain: &impl Field, open: &impl Field, point: Vec3A) {
        let [plain_mm, open_mm] = [plain.distance_mm(point), open.distance_mm(point)];
        let is_near = plain_mm < 2.0;
        assert!(!is_near || plain_mm == open_mm, "{point}: {plain_mm}, {open_mm}");
    }
}
