//! Rotations after which shapes look the same.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use twintac_shape::Shape;

/// The smallest rotation about the vertical after which a shape looks the same, radians; `None` for
/// a round shape.
pub(crate) fn turn_rad(shape: &Shape) -> Option<f64> {
    match shape {
        Shape::Sphere { .. } | Shape::Cylinder { .. } | Shape::Ring { .. } => None,
        Shape::X { .. } => Some(FRAC_PI_2),
        Shape::Box {
            size_mm: [x, y, _], ..
        } if (x - y).abs() < 1e-9 => Some(FRAC_PI_2),
        Shape::Box { .. } | Shape::Wedge { .. } => Some(PI),
        Shape::Triangle { .. } => Some(TAU / 3.0),
        Shape::Stl { .. } | Shape::Union { .. } => Some(TAU),
    }
}

/// An equivalent rotation between minus and plus half of the symmetry angle `turn_rad`.
pub(crate) fn nearest(rad: f64, turn_rad: f64) -> f64 {
    rad - turn_rad * (rad / turn_rad).round()
}
