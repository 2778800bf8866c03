//! The rigid shell around a gel.

use glam::{DVec2, DVec3};

use crate::prism::extrude;
use crate::profile::{PlaneDistance, Profile};
use crate::{Distance, SignedDistance};

/// Largest rounding of the shell's inner rim, mm.
const RIM_RADIUS_MM: f64 = 0.5;

/// A rigid shell seen from the gel in it: a rectangular hole with walls of endless thickness up to a height,
/// their rim rounded. The distance is positive in free space, negative in the walls, and exact.
#[derive(Clone, Debug)]
pub struct Cavity {
    center_mm: DVec2,
    /// The hole, widened by the rim's radius.
    hole: Profile,
    height_mm: f64,
    rim_radius_mm: f64,
}

impl Cavity {
    /// The shell around a gel whose footprint spans `low_mm` to `high_mm`, `gap_mm` away from it on all four
    /// sides, with walls from below the board up to `height_mm`.
    #[must_use]
    pub fn around(low_mm: DVec2, high_mm: DVec2, gap_mm: f64, height_mm: f64) -> Self {
        let rim_radius_mm = RIM_RADIUS_MM.min(0.5 * height_mm);
        let half_mm = 0.5 * (high_mm - low_mm) + DVec2::splat(gap_mm + rim_radius_mm);
        Self {
            center_mm: 0.5 * (low_mm + high_mm),
            hole: Profile::rectangle(half_mm),
            height_mm,
            rim_radius_mm,
        }
    }
}

impl SignedDistance for Cavity {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        let hole = self.hole.signed_distance(point_mm.truncate() - self.center_mm);
        let walls = PlaneDistance {
            distance_mm: -hole.distance_mm,
            gradient: -hole.gradient,
        };
        let above_mm = point_mm.z - (self.height_mm - self.rim_radius_mm);
        let found = extrude(walls, (above_mm, 1.0));
        Distance {
            distance_mm: found.distance_mm - self.rim_radius_mm,
            ..found
        }
    }

    /// Without end in all directions but up.
    fn bounds_mm(&self) -> (DVec3, DVec3) {
        (DVec3::NEG_INFINITY, DVec3::INFINITY.with_z(self.height_mm))
    }
}
