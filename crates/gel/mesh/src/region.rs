//! Whether a point is inside of a gel that is bounded by a triangle surface, the board and
//! inclusions.

use glam::DVec3;
use twintac_shape::SignedDistance;

use crate::Cuboid;
use crate::stencil::Side;

/// The gel: inside of the surface, above the board and outside of the inclusions.
pub(crate) struct Region<'a> {
    surface: &'a dyn SignedDistance,
    inclusions: Vec<Cuboid>,
    board_mm: f64,
    /// Points closer than this to the boundary are on it, mm.
    pub(crate) tolerance_mm: f64,
}

impl<'a> Region<'a> {
    pub(crate) fn new(
        surface: &'a dyn SignedDistance,
        inclusions: &[Cuboid],
        board_mm: f64,
        tolerance_mm: f64,
    ) -> Self {
        // Inclusions on the board are extended below it, so that the gel is bounded there by the
        // board and not by their underside.
        let through_board = |c: &Cuboid| {
            let below = if c.min_mm.z <= board_mm + tolerance_mm {
                DVec3::Z
            } else {
                DVec3::ZERO
            };
            Cuboid {
                min_mm: c.min_mm - below,
                max_mm: c.max_mm,
            }
        };
        Self {
            surface,
            inclusions: inclusions.iter().map(through_board).collect(),
            board_mm,
            tolerance_mm,
        }
    }

    /// Distance of a point from the gel, mm; negative inside. Near the board the surface is
    /// continued straight down. The board itself is not part of this boundary, because it is a
    /// plane of the lattice.
    pub(crate) fn outside_mm(&self, point_mm: DVec3) -> f64 {
        let lifted = point_mm.with_z(point_mm.z.max(self.board_mm + 10.0 * self.tolerance_mm));
        let outside_mm = self.surface.signed_distance(lifted).distance_mm;
        outside_mm.max(-self.inclusion_distance_mm(point_mm))
    }

    /// On which side of the boundary a point is.
    pub(crate) fn side(&self, point_mm: DVec3) -> Side {
        match self.outside_mm(point_mm) {
            outside_mm if outside_mm.abs() <= self.tolerance_mm => Side::On,
            outside_mm if outside_mm < 0.0 => Side::Inside,
            _ => Side::Outside,
        }
    }

    /// Whether a point of the boundary is on the board or an inclusion.
    pub(crate) fn is_bonded(&self, point_mm: DVec3) -> bool {
        point_mm.z <= self.board_mm + self.tolerance_mm || self.is_on_inclusion(point_mm)
    }

    /// Whether a point of the boundary is on an inclusion.
    pub(crate) fn is_on_inclusion(&self, point_mm: DVec3) -> bool {
        self.inclusion_distance_mm(point_mm).abs() <= 2.0 * self.tolerance_mm
    }

    /// Distance to the nearest inclusion, mm; negative inside, infinite without inclusions.
    fn inclusion_distance_mm(&self, point_mm: DVec3) -> f64 {
        self.inclusions
            .iter()
            .map(|inclusion| inclusion.distance_mm(point_mm))
            .fold(f64::INFINITY, f64::min)
    }

    /// The point of the boundary between a point inside and one outside (Illinois method).
    pub(crate) fn cut_mm(&self, inside_mm: DVec3, outside_mm: DVec3) -> DVec3 {
        let at = |share: f64| inside_mm.lerp(outside_mm, share);
        let (mut low, mut high) = (
            (0.0, self.outside_mm(inside_mm)),
            (1.0, self.outside_mm(outside_mm)),
        );
        let mut share = 0.5;
        let mut kept_low = None;
        for _ in 0..40 {
            share = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
            let value = self.outside_mm(at(share));
            if value.abs() <= 0.01 * self.tolerance_mm {
                break;
            }
            // The value at an end that is kept twice in a row is halved.
            if value < 0.0 {
                low = (share, value);
                high.1 *= if kept_low == Some(false) { 0.5 } else { 1.0 };
                kept_low = Some(false);
            } else {
                high = (share, value);
                low.1 *= if kept_low == Some(true) { 0.5 } else { 1.0 };
                kept_low = Some(true);
            }
        }
        at(share)
    }

    /// The point of the boundary near a point, in the same horizontal plane; `None` if it is not
    /// found.
    pub(crate) fn level_foot_mm(&self, point_mm: DVec3) -> Option<DVec3> {
        let mut foot = point_mm;
        for _ in 0..10 {
            let value = self.outside_mm(foot);
            if value.abs() <= 0.1 * self.tolerance_mm {
                return Some(foot);
            }
            let step_mm = self.tolerance_mm;
            let slope = DVec3::new(
                self.outside_mm(foot + DVec3::X * step_mm) - self.outside_mm(foot - DVec3::X * step_mm),
                self.outside_mm(foot + DVec3::Y * step_mm) - self.outside_mm(foot - DVec3::Y * step_mm),
                0.0,
            ) / (2.0 * step_mm);
            foot -= slope * (value / slope.length_squared().max(0.01));
        }
        None
    }
}
