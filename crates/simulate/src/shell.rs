//! The rigid shell around a gel, as four walls. One shape for all of them would have hollow corners, where the direction of the nearest
//! wall jumps and contact finds no rest; a node in a corner touches two walls at once.

use glam::{DVec2, DVec3};
use twintac_shape::{Distance, SignedDistance};

/// Largest rounding of a wall's upper edge, mm.
const RIM_RADIUS_MM: f64 = 0.5;

/// A wall of endless width and thickness, up to a height.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wall {
    /// From the wall to the gel, in the gel's plane.
    inwards: DVec2,
    /// Where the wall stands, against `inwards` from the origin, mm.
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
        // From a wall that is smaller by the rim's radius.
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
    use twintac_shape::Cavity;

    #[test]
    fn the_nearest_wall_is_as_far_as_the_cavity_says() {
        let (low, high) = (DVec2::new(-17.0, -9.0), DVec2::new(17.0, 9.0));
        let walls = Wall::around(low, high, 1.0, 8.5);
        let cavity = Cavity::around(low, high, 1.0, 8.5);
        for x in -19..=19 {
            for y in -11..=11 {
                for z in 0..=12 {
                    // Off the planes where the nearest wall changes.
                    let at = DVec3::new(f64::from(x) + 0.013, f64::from(y) + 0.029, f64::from(z) + 0.007);
                    let expected = cavity.signed_distance(at);
                    let found = walls
                        .iter()
                        .map(|wall| wall.signed_distance(at))
                        .min_by(|a, b| a.distance_mm.total_cmp(&b.distance_mm))
                        .unwrap();
                    if expected.distance_mm > 0.0 {
                        assert!((found.distance_mm - expected.distance_mm).abs() < 1e-9, "{at}");
                        assert!(found.gradient.distance(expected.gradient) < 1e-9, "{at}");
                    }
                }
            }
        }
    }
}
