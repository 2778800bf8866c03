//! The contact geometry of a shape: heights of its underside, by which two shapes can be compared.

use glam::{DQuat, DVec2, DVec3};
use serde::{Deserialize, Serialize};

use crate::SignedDistance;

/// Radius of the innermost ring, mm; ratio of the radii of successive rings; number of rings.
const RINGS: (f64, f64, usize) = (0.25, 1.4, 13);
/// Number of directions of each ring.
const N_DIRECTIONS: usize = 12;
/// Height that is used for everything higher, and beside the shape, mm.
const FAR_MM: f64 = 100.0;
/// Largest number of steps of the search for the underside. Rays that graze a side advance too
/// slowly, and count as beside the shape.
const MOST_STEPS: usize = 200;

/// The underside of a shape in the orientation in which it presses: heights above its lowest point,
/// at the origin and on rings around it, mm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Underside {
    heights_mm: Vec<f64>,
}

impl Underside {
    /// Computes the underside of a shape with this orientation.
    #[must_use]
    pub fn of(shape: &dyn SignedDistance, rotation: DQuat) -> Self {
        let (low, high) = shape.bounds_mm();
        let reach_mm = low.abs().max(high.abs()).length();
        let mut heights_mm: Vec<f64> = places_mm()
            .map(|place| height_mm(shape, rotation, place, reach_mm).unwrap_or(FAR_MM))
            .collect();
        let lowest_mm = heights_mm.iter().copied().fold(f64::INFINITY, f64::min);
        for height in &mut heights_mm {
            // Rounded to 0.0001 mm, which is accurate enough and short in files.
            *height = (1e4 * (*height - lowest_mm).min(FAR_MM)).round() / 1e4;
        }
        Self { heights_mm }
    }

    /// How differently two shapes indent a flat gel at the same depth (mm): the volume that only
    /// one of them displaces, divided by the volume that at least one of them displaces. It is 0
    /// for equal indentations, 1 if nothing is shared, and 0 if neither touches the gel.
    #[must_use]
    pub fn difference(&self, other: &Self, depth_mm: f64) -> f64 {
        let (mut shared, mut either) = (0.0, 0.0);
        for ((own, other), area) in self.heights_mm.iter().zip(&other.heights_mm).zip(areas_mm2()) {
            shared += area * (depth_mm - own.max(*other)).max(0.0);
            either += area * (depth_mm - own.min(*other)).max(0.0);
        }
        if either > 0.0 { 1.0 - shared / either } else { 0.0 }
    }
}

/// Radii of the rings, mm.
fn radii_mm() -> impl Iterator<Item = f64> {
    let (first_mm, ratio, n_rings) = RINGS;
    let wider = move |radius_mm: &f64| Some(radius_mm * ratio);
    std::iter::successors(Some(first_mm), wider).take(n_rings)
}

/// Points at which heights are taken, mm.
fn places_mm() -> impl Iterator<Item = DVec2> {
    let step = std::f64::consts::TAU / N_DIRECTIONS as f64;
    let ring =
        move |radius_mm: f64| (0..N_DIRECTIONS).map(move |i| radius_mm * DVec2::from_angle(step * i as f64));
    std::iter::once(DVec2::ZERO).chain(radii_mm().flat_map(ring))
}

/// The area that each height represents, mm². Its limits are the geometric means of the radii of
/// neighbouring rings.
fn areas_mm2() -> impl Iterator<Item = f64> {
    let (first_mm, ratio, _) = RINGS;
    let pi = std::f64::consts::PI;
    let share =
        move |radius_mm: f64| pi * radius_mm * radius_mm * (ratio - 1.0 / ratio) / N_DIRECTIONS as f64;
    let middle = pi * first_mm * first_mm / ratio;
    std::iter::once(middle)
        .chain(radii_mm().flat_map(move |radius_mm| std::iter::repeat_n(share(radius_mm), N_DIRECTIONS)))
}

/// Height of the turned shape's underside above its origin at a point, mm; `None` beside the shape.
fn height_mm(shape: &dyn SignedDistance, rotation: DQuat, place: DVec2, reach_mm: f64) -> Option<f64> {
    let back = rotation.inverse();
    let mut z_mm = -1.5 * reach_mm;
    for _ in 0..MOST_STEPS {
        let point: DVec3 = back * place.extend(z_mm);
        let distance_mm = shape.signed_distance(point).distance_mm;
        if distance_mm < 1e-6 {
            return Some(z_mm);
        }
        z_mm += distance_mm;
        if z_mm > 1.5 * reach_mm {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Shape, Surfaces};

    fn underside(shape: &Shape, rotation: DQuat) -> Underside {
        let field = shape.signed_distance_field(&Surfaces::default()).unwrap();
        Underside::of(field.as_ref(), rotation)
    }

    fn ball(radius_mm: f64) -> Underside {
        underside(&Shape::Sphere { radius_mm }, DQuat::IDENTITY)
    }

    #[test]
    fn a_ball_is_as_high_as_its_circle() {
        let ball = ball(5.0);
        for (height_mm, place) in ball.heights_mm.iter().zip(places_mm()) {
            let r = place.length();
            if r < 4.5 {
                let expected = 5.0 - (25.0 - r * r).sqrt();
                assert!((height_mm - expected).abs() < 1e-3, "{r} mm: {height_mm}");
            } else if r > 5.0 {
                assert!(*height_mm > 5.0, "{r} mm: {height_mm}");
            }
        }
    }

    #[test]
    fn shapes_differ_by_what_they_dent_and_turned_balls_do_not() {
        let same = underside(&Shape::Sphere { radius_mm: 5.0 }, DQuat::from_rotation_z(0.7));
        assert!(ball(5.0).difference(&same, 1.0) < 1e-3);
        // A shallow indentation of a ball has the volume π R d².
        let by_radius = ball(5.0).difference(&ball(10.0), 0.2);
        assert!((by_radius - 0.5).abs() < 0.06, "{by_radius}");
        let punch = Shape::Cylinder {
            radius_mm: 5.0,
            height_mm: 10.0,
            edge_radius_mm: 0.8,
        };
        let punch = underside(&punch, DQuat::IDENTITY);
        for depth_mm in [0.05, 0.5, 1.5] {
            assert!(ball(12.5).difference(&punch, depth_mm) > 0.3, "{depth_mm}");
        }
        assert_eq!(ball(5.0).difference(&punch, -0.1), 0.0);
    }
}
