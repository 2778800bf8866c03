//! Thickness of a sampled body under its faces.

use std::collections::BTreeMap;

use glam::Vec3A;

use super::field::Field;

/// Thickness above which a body counts as infinitely thick, mm: no press goes so deep.
const THICKEST_MM: f32 = 12.0;

/// Step into a body, mm.
const STEP_MM: f32 = 0.25;

/// Resolution of normals: components are rounded to multiples of one over this.
const NORMALS: f32 = 4.0;

/// A face is across a body from another one if the cosine of the angle between their outward
/// normals is below this. A path that leaves through a neighbouring face says how sharp an edge is,
/// not how thin the body.
const ACROSS: f32 = -0.7;

/// Smallest upward component of the normal of a top.
const LEAST_TOP: f32 = 0.5 - 1.0 / NORMALS;

/// Half of the thickness of a body under each face that has another one across, mm, by the normal
/// of the face.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Thickness {
    halves_mm: Vec<(Vec3A, f32)>,
    /// The smallest of them, mm.
    pub(super) least_mm: f32,
}

impl Thickness {
    /// Thickness under the faces near these points.
    pub(super) fn of(field: &impl Field, near_surface: impl Iterator<Item = Vec3A>) -> Self {
        let mut thinnest: BTreeMap<[i8; 3], f32> = BTreeMap::new();
        for point in near_surface {
            let outwards = normal(field, point);
            let surface = point - field.distance_mm(point) * outwards;
            let inside = |step: u32| surface - STEP_MM * step as f32 * outwards;
            let n_steps = (THICKEST_MM / STEP_MM) as u32;
            let Some(step) = (1..n_steps).find(|&step| field.distance_mm(inside(step)) > 0.0) else {
                continue;
            };
            if normal(field, inside(step)).dot(outwards) > ACROSS {
                continue;
            }
            let key = (NORMALS * outwards).round().to_array().map(|part| part as i8);
            let half_mm = 0.5 * STEP_MM * (step - 1) as f32;
            let known = thinnest.entry(key).or_insert(half_mm);
            *known = known.min(half_mm);
        }
        let halves_mm: Vec<(Vec3A, f32)> = thinnest
            .into_iter()
            .map(|(key, half_mm)| (Vec3A::from_array(key.map(f32::from)).normalize_or_zero(), half_mm))
            .collect();
        Self {
            least_mm: halves_mm
                .iter()
                .map(|half| half.1)
                .fold(0.5 * THICKEST_MM, f32::min),
            halves_mm,
        }
    }

    /// Whether a point at this depth, mm, may be nearer to a top than to the lower side.
    pub(super) fn is_thin(&self, depth_mm: f32, up: Vec3A) -> bool {
        let mut halves = self.halves_mm.iter();
        halves.any(|(normal, half_mm)| depth_mm > *half_mm && normal.dot(up) > LEAST_TOP)
    }
}

/// Outward normal: the direction in which the distance grows.
fn normal(field: &impl Field, point: Vec3A) -> Vec3A {
    let difference = |axis: Vec3A| field.distance_mm(point + axis) - field.distance_mm(point - axis);
    let axes = [Vec3A::X, Vec3A::Y, Vec3A::Z].map(|axis| difference(STEP_MM * axis));
    Vec3A::from_array(axes).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use twintac_shape::{Shape, Surfaces};

    use super::super::samples::Samples;
    use super::super::upward::Upward;
    use super::*;

    fn is_thin(shape: &Shape, depth_mm: f32, up: Vec3A) -> bool {
        let exact = shape.signed_distance_field(&Surfaces::new()).unwrap();
        Samples::of(exact.as_ref()).is_thin(depth_mm, Upward::new(up.normalize()))
    }

    fn triangle(height_mm: f64) -> Shape {
        Shape::Triangle {
            side_mm: 20.0,
            height_mm,
            edge_radius_mm: 0.2,
        }
    }

    #[test]
    fn a_sharp_corner_is_not_thin_and_a_plate_is() {
        for up in [Vec3A::Z, Vec3A::new(0.1, 0.2, 1.0), Vec3A::new(-0.3, 0.1, 1.0)] {
            assert!(!is_thin(&triangle(10.0), 1.9, up), "{up}");
            assert!(is_thin(&triangle(1.0), 0.6, up), "{up}");
            assert!(!is_thin(&triangle(1.0), 0.2, up), "{up}");
        }
    }
}
