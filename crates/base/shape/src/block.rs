//! A block whose top edges may be round.

use glam::{DVec2, DVec3};

use crate::Distance;
use crate::profile::PlaneDistance;

/// A block that stands on z = 0, centred on the z axis. It is the intersection of an arch along x
/// and an arch along y, so that two rounded edges meet in a mitre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block {
    pub(crate) size_mm: DVec3,
    pub(crate) edge_radius_mm: f64,
}

impl Block {
    /// Exact inside, and outside beside faces and rounded edges. Outside, next to the ridges at the
    /// corners, it is a lower bound.
    pub(crate) fn signed_distance(&self, point_mm: DVec3) -> Distance {
        let along_x = self.arch(0.5 * self.size_mm.x, DVec2::new(point_mm.x, point_mm.z));
        let along_y = self.arch(0.5 * self.size_mm.y, DVec2::new(point_mm.y, point_mm.z));
        if along_x.distance_mm >= along_y.distance_mm {
            let gradient = DVec3::new(along_x.gradient.x, 0.0, along_x.gradient.y);
            Distance {
                distance_mm: along_x.distance_mm,
                gradient,
            }
        } else {
            let gradient = DVec3::new(0.0, along_y.gradient.x, along_y.gradient.y);
            Distance {
                distance_mm: along_y.distance_mm,
                gradient,
            }
        }
    }

    /// Height of the top, mm; `None` beside the block.
    pub(crate) fn top_height_mm(&self, at_mm: DVec2) -> Option<f64> {
        let over_mm = at_mm.abs() - 0.5 * self.size_mm.truncate();
        if over_mm.max_element() > 0.0 {
            return None;
        }
        let radius_mm = self.edge_radius_mm;
        let into_rounding_mm = (over_mm.max_element() + radius_mm).max(0.0);
        Some(self.size_mm.z - radius_mm + (radius_mm.powi(2) - into_rounding_mm.powi(2)).max(0.0).sqrt())
    }

    pub(crate) fn volume_mm3(&self) -> f64 {
        let DVec3 { x, y, z } = self.size_mm;
        let r = self.edge_radius_mm;
        let quarter = std::f64::consts::FRAC_PI_4;
        // A rounded edge removes (1 - π/4) r² for each length of edge; the mitres at the four
        // corners are counted twice.
        x * y * z - 2.0 * (x + y) * r.powi(2) * (1.0 - quarter) + 8.0 * r.powi(3) * (5.0 / 6.0 - quarter)
    }

    /// Exact distance to a rectangle that stands on 0 and whose two upper corners are round.
    fn arch(&self, half_width_mm: f64, point_mm: DVec2) -> PlaneDistance {
        let side = if point_mm.x < 0.0 { -1.0 } else { 1.0 };
        let radius_mm = self.edge_radius_mm;
        let height_mm = self.size_mm.z;
        let folded = DVec2::new(point_mm.x.abs(), point_mm.y);
        let from_arc = folded - DVec2::new(half_width_mm - radius_mm, height_mm - radius_mm);
        let length_mm = from_arc.length();
        let found = if from_arc.min_element() > 0.0 && radius_mm > 0.0 && length_mm > f64::MIN_POSITIVE {
            PlaneDistance {
                distance_mm: length_mm - radius_mm,
                gradient: from_arc / length_mm,
            }
        } else {
            rectangle(folded, half_width_mm, height_mm)
        };
        PlaneDistance {
            gradient: found.gradient * DVec2::new(side, 1.0),
            ..found
        }
    }
}

/// Exact distance to a rectangle from 0 to a height, for a point with x >= 0.
fn rectangle(point_mm: DVec2, half_width_mm: f64, height_mm: f64) -> PlaneDistance {
    let aside_mm = point_mm.x - half_width_mm;
    let (over_mm, up) = if point_mm.y > 0.5 * height_mm {
        (point_mm.y - height_mm, 1.0)
    } else {
        (-point_mm.y, -1.0)
    };
    let over = DVec2::new(0.0, up);
    if aside_mm > 0.0 && over_mm > 0.0 {
        let distance_mm = aside_mm.hypot(over_mm);
        let gradient = ((DVec2::X * aside_mm + over * over_mm) / distance_mm).normalize();
        PlaneDistance {
            distance_mm,
            gradient,
        }
    } else if aside_mm > over_mm {
        PlaneDistance {
            distance_mm: aside_mm,
            gradient: DVec2::X,
        }
    } else {
        PlaneDistance {
            distance_mm: over_mm,
            gradient: over,
        }
    }
}
