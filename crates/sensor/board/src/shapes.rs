//! Shapes of copper and the exact distances between them, in the plane, mm.

use glam::DVec2;

/// A piece of copper, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    /// A rectangle along the axes: its centre, and half of its size.
    Rect { center: DVec2, half: DVec2 },
    /// All points within a radius of a line segment. A segment of length zero is a disc.
    Capsule { from: DVec2, to: DVec2, radius: f64 },
}

impl Shape {
    pub(crate) fn disc(center: DVec2, radius: f64) -> Self {
        Self::Capsule {
            from: center,
            to: center,
            radius,
        }
    }

    /// Distance from a point to the shape, mm; negative inside.
    pub(crate) fn distance(&self, point: DVec2) -> f64 {
        match *self {
            Self::Rect { center, half } => {
                let beyond = (point - center).abs() - half;
                beyond.max(DVec2::ZERO).length() + beyond.max_element().min(0.0)
            }
            Self::Capsule { from, to, radius } => to_segment(point, from, to) - radius,
        }
    }

    /// The bounding box, as minimum and maximum corner.
    pub(crate) fn bounds(&self) -> (DVec2, DVec2) {
        match *self {
            Self::Rect { center, half } => (center - half, center + half),
            Self::Capsule { from, to, radius } => (from.min(to) - radius, from.max(to) + radius),
        }
    }
}

/// Distance from a point to the segment between two points.
pub(crate) fn to_segment(point: DVec2, from: DVec2, to: DVec2) -> f64 {
    let along = to - from;
    let length_squared = along.length_squared();
    let part = if length_squared > 0.0 {
        ((point - from).dot(along) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    point.distance(from + part * along)
}

/// Distance between two segments; 0 if they cross.
pub(crate) fn between_segments(one: (DVec2, DVec2), two: (DVec2, DVec2)) -> f64 {
    let side = |line: (DVec2, DVec2), point: DVec2| (line.1 - line.0).perp_dot(point - line.0);
    let crosses =
        |line: (DVec2, DVec2), other: (DVec2, DVec2)| side(line, other.0) * side(line, other.1) < 0.0;
    if crosses(one, two) && crosses(two, one) {
        return 0.0;
    }
    let ends = [
        to_segment(one.0, two.0, two.1),
        to_segment(one.1, two.0, two.1),
        to_segment(two.0, one.0, one.1),
        to_segment(two.1, one.0, one.1),
    ];
    ends.into_iter().fold(f64::INFINITY, f64::min)
}

/// A box along the axes, such as a courtyard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Area {
    pub(crate) min: DVec2,
    pub(crate) max: DVec2,
}

impl Area {
    pub(crate) fn about(center: DVec2, half: DVec2) -> Self {
        Self {
            min: center - half,
            max: center + half,
        }
    }

    pub(crate) fn center(&self) -> DVec2 {
        0.5 * (self.min + self.max)
    }

    pub(crate) fn size(&self) -> DVec2 {
        self.max - self.min
    }

    pub(crate) fn grown(&self, by: f64) -> Self {
        Self {
            min: self.min - by,
            max: self.max + by,
        }
    }

    pub(crate) fn meets(&self, other: &Self) -> bool {
        const TOUCH: f64 = 1e-9;
        self.min.cmplt(other.max - TOUCH).all() && other.min.cmplt(self.max - TOUCH).all()
    }

    pub(crate) fn holds(&self, other: &Self) -> bool {
        const TOUCH: f64 = 1e-9;
        self.min.cmple(other.min + TOUCH).all() && other.max.cmple(self.max + TOUCH).all()
    }

    pub(crate) fn joined(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }
}
