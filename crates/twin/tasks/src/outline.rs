//! Outlines of shapes from above, for pictures and for edges that are followed.

use std::f64::consts::TAU;

use glam::DVec2;
use twintac_shape::{Pose, Shape};

/// Corners of the polygon that stands for a circle.
const N_ROUND: usize = 48;

/// Outlines of the face of a shape that comes near, in the gel's frame, mm; empty for a shape whose
/// outline is not known by a formula. Outer outlines are counterclockwise.
pub(crate) fn outline_mm(shape: &Shape, gel_from_body: &Pose) -> Vec<Vec<DVec2>> {
    let outlines = match *shape {
        Shape::Sphere { radius_mm } | Shape::Cylinder { radius_mm, .. } => vec![circle(radius_mm)],
        Shape::Ring {
            outer_radius_mm,
            inner_radius_mm,
            ..
        } => vec![circle(outer_radius_mm), circle(inner_radius_mm)],
        Shape::Box { size_mm, .. } => vec![rectangle(size_mm[0], size_mm[1])],
        Shape::Triangle { side_mm, .. } => vec![polygon(3, side_mm / 3.0_f64.sqrt())],
        Shape::Wedge { length_mm, .. } => vec![rectangle(0.5, length_mm)],
        Shape::X {
            length_mm, width_mm, ..
        } => {
            let turned = |bar: Vec<DVec2>| {
                bar.into_iter()
                    .map(|at| DVec2::from_angle(TAU / 8.0).rotate(at))
                    .collect()
            };
            vec![
                turned(rectangle(length_mm, width_mm)),
                turned(rectangle(width_mm, length_mm)),
            ]
        }
        Shape::Stl { .. } | Shape::Union { .. } => Vec::new(),
    };
    let placed = |at: DVec2| gel_from_body.transform_point(at.extend(0.0)).truncate();
    outlines
        .into_iter()
        .map(|outline| outline.into_iter().map(placed).collect())
        .collect()
}

fn circle(radius_mm: f64) -> Vec<DVec2> {
    polygon(N_ROUND, radius_mm)
}

fn polygon(n: usize, radius_mm: f64) -> Vec<DVec2> {
    let corner = |number: usize| radius_mm * DVec2::from_angle(TAU * number as f64 / n as f64);
    (0..n).map(corner).collect()
}

fn rectangle(x_mm: f64, y_mm: f64) -> Vec<DVec2> {
    let half = 0.5 * DVec2::new(x_mm, y_mm);
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|corner| half * DVec2::from(corner))
        .to_vec()
}
