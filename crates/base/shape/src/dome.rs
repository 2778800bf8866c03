//! A gel with a domed top.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use crate::Distance;

/// Number of halvings of an interval, after which it is as narrow as double precision allows.
const HALVINGS: usize = 100;

/// A rectangular footprint whose top falls off quadratically from a crown. With `s` the fraction of
/// the way from the crown to an edge, the height of the top is `crown - drop_x s_x² - drop_y s_y²`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dome {
    /// Footprint along x, mm: [minimum, maximum].
    pub x_mm: [f64; 2],
    /// Footprint along y, mm: [minimum, maximum].
    pub y_mm: [f64; 2],
    /// Position of the crown, mm: [x, y].
    pub crown_at_mm: [f64; 2],
    /// Height of the crown, mm.
    pub crown_mm: f64,
    /// Fall from the crown to the edge at minimum and maximum x, mm.
    pub drop_x_mm: [f64; 2],
    /// Fall from the crown to the edge at minimum and maximum y, mm.
    pub drop_y_mm: [f64; 2],
}

/// The quadratic fall of the top along one axis, `curvature (at - crown)²`.
#[derive(Clone, Copy)]
struct Fall {
    crown_at_mm: f64,
    low_mm: f64,
    high_mm: f64,
    /// On the side of the low and of the high end, 1/mm.
    curvature: [f64; 2],
}

impl Fall {
    fn new([low_mm, high_mm]: [f64; 2], crown_at_mm: f64, drop_mm: [f64; 2]) -> Self {
        // A crown above an edge has no length to fall over on that side.
        let curvature = |reach_mm: f64, drop_mm: f64| {
            if reach_mm > 0.0 {
                drop_mm / reach_mm.powi(2)
            } else {
                0.0
            }
        };
        let curvature = [
            curvature(crown_at_mm - low_mm, drop_mm[0]),
            curvature(high_mm - crown_at_mm, drop_mm[1]),
        ];
        Self {
            crown_at_mm,
            low_mm,
            high_mm,
            curvature,
        }
    }

    fn curvature(&self, at_mm: f64) -> f64 {
        self.curvature[usize::from(at_mm > self.crown_at_mm)]
    }

    fn drop_mm(&self, at_mm: f64) -> f64 {
        self.curvature(at_mm) * (at_mm - self.crown_at_mm).powi(2)
    }

    fn slope(&self, at_mm: f64) -> f64 {
        2.0 * self.curvature(at_mm) * (at_mm - self.crown_at_mm)
    }

    /// The coordinate of the closest point of the top, for a Lagrange multiplier of the equation of
    /// the top.
    fn pulled(&self, at_mm: f64, multiplier: f64) -> f64 {
        let away_mm = (at_mm - self.crown_at_mm) / (1.0 + 2.0 * multiplier * self.curvature(at_mm));
        (self.crown_at_mm + away_mm).clamp(self.low_mm, self.high_mm)
    }
}

impl Dome {
    fn falls(&self) -> [Fall; 2] {
        [
            Fall::new(self.x_mm, self.crown_at_mm[0], self.drop_x_mm),
            Fall::new(self.y_mm, self.crown_at_mm[1], self.drop_y_mm),
        ]
    }

    fn corners(&self) -> (DVec3, DVec3) {
        (
            DVec3::new(self.x_mm[0], self.y_mm[0], 0.0),
            DVec3::new(self.x_mm[1], self.y_mm[1], self.crown_mm),
        )
    }

    /// Smallest box that holds the dome, mm.
    pub(crate) fn bounds_mm(&self) -> (DVec3, DVec3) {
        self.corners()
    }

    /// Height of the top above a point of the footprint, mm; `None` beside the footprint.
    #[must_use]
    pub fn top_height_mm(&self, x_mm: f64, y_mm: f64) -> Option<f64> {
        let (low, high) = self.corners();
        let at = DVec2::new(x_mm, y_mm);
        (at.cmpge(low.truncate()).all() && at.cmple(high.truncate()).all()).then(|| self.height_mm(at))
    }

    /// Volume, mm³. The mean of a quadratic fall is a third of its depth.
    pub(crate) fn volume_mm3(&self) -> f64 {
        let size = self.corners().1 - self.corners().0;
        let mean_fall_mm = |ends: [f64; 2], crown_at: f64, drops: [f64; 2]| {
            ((crown_at - ends[0]) * drops[0] + (ends[1] - crown_at) * drops[1]) / (3.0 * (ends[1] - ends[0]))
        };
        let along_x_mm = mean_fall_mm(self.x_mm, self.crown_at_mm[0], self.drop_x_mm);
        let along_y_mm = mean_fall_mm(self.y_mm, self.crown_at_mm[1], self.drop_y_mm);
        size.x * size.y * (self.crown_mm - along_x_mm - along_y_mm)
    }

    fn height_mm(&self, at_mm: DVec2) -> f64 {
        let [x, y] = self.falls();
        self.crown_mm - x.drop_mm(at_mm.x) - y.drop_mm(at_mm.y)
    }

    /// Exact outside. Inside it is exact if the point is not further below the top than the
    /// smallest radius of curvature of the top.
    ///
    /// The closest point of a convex set bounded by a separable quadratic depends on a single
    /// Lagrange multiplier, which is found by bisection.
    pub(crate) fn signed_distance(&self, point_mm: DVec3) -> Distance {
        let (low, high) = self.corners();
        let clamped = point_mm.clamp(low, high.with_z(f64::INFINITY));
        if clamped.z > self.height_mm(clamped.truncate()) {
            return self.beyond_top(point_mm);
        }
        if clamped != point_mm {
            let away = point_mm - clamped;
            return Distance {
                distance_mm: away.length(),
                gradient: away.normalize(),
            };
        }
        let walls = [
            (low.x - point_mm.x, -DVec3::X),
            (point_mm.x - high.x, DVec3::X),
            (low.y - point_mm.y, -DVec3::Y),
            (point_mm.y - high.y, DVec3::Y),
            (-point_mm.z, -DVec3::Z),
        ];
        walls
            .into_iter()
            .fold(self.below_top(point_mm), |closest, (distance_mm, gradient)| {
                if distance_mm > closest.distance_mm {
                    Distance {
                        distance_mm,
                        gradient,
                    }
                } else {
                    closest
                }
            })
    }

    fn pulled(&self, point_mm: DVec3, multiplier: f64) -> DVec3 {
        let [x, y] = self.falls();
        let z_mm = (point_mm.z - multiplier).max(0.0);
        DVec3::new(
            x.pulled(point_mm.x, multiplier),
            y.pulled(point_mm.y, multiplier),
            z_mm,
        )
    }

    fn above_top_mm(&self, point_mm: DVec3) -> f64 {
        point_mm.z - self.height_mm(point_mm.truncate())
    }

    fn normal(&self, point_mm: DVec3) -> DVec3 {
        let [x, y] = self.falls();
        DVec3::new(x.slope(point_mm.x), y.slope(point_mm.y), 1.0).normalize()
    }

    fn beyond_top(&self, point_mm: DVec3) -> Distance {
        let (mut low, mut high) = (0.0, 1.0);
        while self.above_top_mm(self.pulled(point_mm, high)) > 0.0 {
            high *= 2.0;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if self.above_top_mm(self.pulled(point_mm, middle)) > 0.0 {
                low = middle
            } else {
                high = middle
            }
        }
        let closest = self.pulled(point_mm, high);
        let away = point_mm - closest;
        let distance_mm = away.length();
        // This close to the top, rounding spoils the direction, but not the normal.
        let gradient = if distance_mm > 1e-6 {
            away / distance_mm
        } else {
            self.normal(closest)
        };
        Distance {
            distance_mm,
            gradient,
        }
    }

    fn below_top(&self, point_mm: DVec3) -> Distance {
        let [x, y] = self.falls();
        let curvature = x.curvature(point_mm.x).max(y.curvature(point_mm.y));
        let vertical_mm = -self.above_top_mm(point_mm);
        let lowest = if curvature > 0.0 {
            (-0.5 / curvature * (1.0 - 1e-9)).max(-vertical_mm)
        } else {
            -vertical_mm
        };
        let (mut low, mut high) = (lowest, 0.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if self.above_top_mm(self.pulled(point_mm, middle)) > 0.0 {
                low = middle
            } else {
                high = middle
            }
        }
        let closest = self.pulled(point_mm, low);
        let distance_mm = closest.distance(point_mm).min(vertical_mm);
        Distance {
            distance_mm: -distance_mm,
            gradient: self.normal(closest),
        }
    }
}
