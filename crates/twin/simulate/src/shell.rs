//! The rigid shell around a gel, as four walls. A single shape for all walls would have concave
//! corners, where the direction to the nearest wall jumps and the contact iteration does not
//! converge. With four walls, a node in a corner touches two of them at once.

use glam::{DVec2, DVec3};
use twintac_shape::{Distance, SignedDistance};

/// Largest rounding of a wall's upper edge, mm.
const RIM_RADIUS_MM: f64 = 0.5;

/// A wall of infinite width and thickness, up to a height.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wall {
    /// Unit vector from the wall to the gel, in the gel's plane.
    inwards: DVec2,
    /// Position of the wall: distance from the origin against `inwards`, mm.
    offset_mm: f64,
    height_mm: f64,
    rim_radius_mm: f64,
}

impl Wall {
    /// The walls around a gel whose footprint spans `low_mm` to `high_mm`, a gap away from it.
    pub(crate) fn around(low_mm: DVec2, high_mm: DVec2, gap_mm: f64, height_mm: f64) -> [Self; 4] {
        let wall = |inwards: DVec2, offset_mm: f64| Self {
            inwards,
            offset_mm: offset_mm + gap_mm,
            height_mm,
            rim_radius_mm: RIM_RADIUS_MM.min(0.5 * height_mm),
        };
        [
            wall(DVec2::X, -low_mm.x),
            wall(DVec2::NEG_X, high_mm.x),
            wall(DVec2::Y, -low_mm.y),
            wall(DVec2::NEG_Y, high_mm.y),
        ]
    }
}

impl SignedDistance for Wall {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        let inwards = self.inwards.extend(0.0);
        // Distance from a wall that is smaller by the rim's radius.
        let beside_mm = inwards.dot(point_mm) + self.offset_mm + self.rim_radius_mm;
        let above_mm = point_mm.z - self.height_mm + self.rim_radius_mm;
        let (from_inner_mm, gradient) = if beside_mm > 0.0 && above_mm > 0.0 {
            let way = inwards * beside_mm + DVec3::Z * above_mm;
            (way.length(), way.normalize())
        } else if beside_mm > above_mm {
            (beside_mm, inwards)
        } else {
            (above_mm, DVec3::Z)
        };
        Distance {
            distance_mm: from_inner_mm - self.rim_radius_mm,
            gradient,
        }
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        (DVec3::NEG_INFINITY, DVec3::INFINITY.with_z(self.height_mm))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walls_stand_a_gap_away_and_have_round_rims() {
        let walls = Wall::around(DVec2::new(-5.0, -4.0), DVec2::new(7.0, 4.0), 1.0, 5.0);
        let nearest = |x: f64, y: f64, z: f64| {
            let found = walls.map(|wall| wall.signed_distance(DVec3::new(x, y, z)));
            found
                .into_iter()
                .min_by(|a, b| a.distance_mm.total_cmp(&b.distance_mm))
        };
        let sqrt_half = 0.5f64.sqrt();
        for (at, distance_mm, gradient) in [
            ([7.0, 0.0, 2.0], 1.0, DVec3::NEG_X),
            ([0.0, -4.5, 0.0], 0.5, DVec3::Y),
            ([9.0, 0.0, 2.0], -1.0, DVec3::NEG_X),
            ([20.0, 0.0, 6.0], 1.0, DVec3::Z),
            // The point lies where a sharp rim would be: the rim rounded by 0.5 mm is (√2 - 1)/2
            // away.
            (
                [8.0, 0.0, 5.0],
                sqrt_half - 0.5,
                DVec3::new(-sqrt_half, 0.0, sqrt_half),
            ),
        ] {
            let found = nearest(at[0], at[1], at[2]);
            assert!(
                found.is_some_and(|found| (found.distance_mm - distance_mm).abs() < 1e-12
                    && found.gradient.distance(gradient) < 1e-12),
                "{found:?} at {at:?}"
            );
        }
    }
}
