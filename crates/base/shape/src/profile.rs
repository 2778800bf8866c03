//! Exact signed distances in the plane.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

use glam::{DVec2, Vec2Swizzles};

/// Signed distance in a plane, with its outward unit gradient.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlaneDistance {
    pub(crate) distance_mm: f64,
    pub(crate) gradient: DVec2,
}

/// A flat figure about the origin of its plane.
#[derive(Clone, Debug)]
pub(crate) enum Profile {
    /// A disc.
    Disc { radius_mm: f64 },
    /// The area between two radii.
    Annulus {
        inner_radius_mm: f64,
        outer_radius_mm: f64,
    },
    /// Two crossed bars along the diagonals of the plane. Their concave corners are rounded, by a
    /// radius of at most the difference of the sizes.
    X {
        half_length_mm: f64,
        half_width_mm: f64,
        hollow_radius_mm: f64,
    },
    /// A convex polygon with at least three corners, counterclockwise, without edges of length
    /// zero.
    Convex { corners_mm: Vec<DVec2> },
}

impl Profile {
    /// A rectangle about the origin, given half its size.
    pub(crate) fn rectangle(half_mm: DVec2) -> Self {
        let corner = |x: f64, y: f64| DVec2::new(x, y) * half_mm;
        Self::Convex {
            corners_mm: vec![
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ],
        }
    }

    pub(crate) fn signed_distance(&self, point_mm: DVec2) -> PlaneDistance {
        match self {
            Self::Disc { radius_mm } => {
                let from_axis_mm = point_mm.length();
                PlaneDistance {
                    distance_mm: from_axis_mm - radius_mm,
                    gradient: outward(point_mm, from_axis_mm),
                }
            }
            Self::Annulus {
                inner_radius_mm,
                outer_radius_mm,
            } => {
                let from_axis_mm = point_mm.length();
                let out = outward(point_mm, from_axis_mm);
                let (to_outer_mm, to_inner_mm) =
                    (from_axis_mm - outer_radius_mm, inner_radius_mm - from_axis_mm);
                if to_outer_mm >= to_inner_mm {
                    PlaneDistance {
                        distance_mm: to_outer_mm,
                        gradient: out,
                    }
                } else {
                    PlaneDistance {
                        distance_mm: to_inner_mm,
                        gradient: -out,
                    }
                }
            }
            Self::X {
                half_length_mm,
                half_width_mm,
                hollow_radius_mm,
            } => {
                let eighth = DVec2::from_angle(FRAC_PI_4);
                let along_bars_mm = eighth.rotate(point_mm);
                let found = crossed_bars(
                    DVec2::new(*half_length_mm, *half_width_mm),
                    *hollow_radius_mm,
                    along_bars_mm,
                );
                PlaneDistance {
                    gradient: DVec2::new(eighth.x, -eighth.y).rotate(found.gradient),
                    ..found
                }
            }
            Self::Convex { corners_mm } => convex(corners_mm, point_mm),
        }
    }

    /// Lowest and highest coordinates, mm.
    pub(crate) fn bounds_mm(&self) -> (DVec2, DVec2) {
        match self {
            Self::Disc { radius_mm: r }
            | Self::Annulus {
                outer_radius_mm: r, ..
            } => (DVec2::splat(-r), DVec2::splat(*r)),
            Self::X {
                half_length_mm,
                half_width_mm,
                ..
            } => {
                let reach_mm = DVec2::splat((half_length_mm + half_width_mm) * FRAC_1_SQRT_2);
                (-reach_mm, reach_mm)
            }
            Self::Convex { corners_mm } => corners_mm
                .iter()
                .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), corner| {
                    (low.min(*corner), high.max(*corner))
                }),
        }
    }
}

/// Direction away from the axis; on the axis, an arbitrary one.
fn outward(point_mm: DVec2, length_mm: f64) -> DVec2 {
    if length_mm > f64::MIN_POSITIVE {
        point_mm / length_mm
    } else {
        DVec2::X
    }
}

/// Crossed bars along both axes, given by half of their length and width, evaluated in the octant
/// of the plane that contains half of a bar's side and end.
fn crossed_bars(half_mm: DVec2, hollow_radius_mm: f64, point_mm: DVec2) -> PlaneDistance {
    let mut folded_mm = point_mm.abs();
    let is_swapped = folded_mm.y > folded_mm.x;
    if is_swapped {
        folded_mm = folded_mm.yx();
    }
    let hollow_center_mm = DVec2::splat(half_mm.y + hollow_radius_mm);
    let beyond_mm = folded_mm - half_mm;
    let mut found = if folded_mm.x < hollow_center_mm.x {
        let to_center_mm = hollow_center_mm - folded_mm;
        let from_center_mm = to_center_mm.length();
        PlaneDistance {
            distance_mm: hollow_radius_mm - from_center_mm,
            gradient: outward(to_center_mm, from_center_mm),
        }
    } else {
        PlaneDistance {
            distance_mm: beyond_mm.y,
            gradient: DVec2::Y,
        }
    };
    if beyond_mm.x > 0.0 && beyond_mm.y > 0.0 {
        let distance_mm = beyond_mm.length();
        found = PlaneDistance {
            distance_mm,
            gradient: beyond_mm / distance_mm,
        };
    } else if beyond_mm.x > found.distance_mm {
        found = PlaneDistance {
            distance_mm: beyond_mm.x,
            gradient: DVec2::X,
        };
    }
    if is_swapped {
        found.gradient = found.gradient.yx();
    }
    found.gradient *= DVec2::ONE.copysign(point_mm);
    found
}

/// Inside, the distance is that to the line of the nearest edge; outside, to the nearest point of
/// the nearest edge.
fn convex(corners_mm: &[DVec2], point_mm: DVec2) -> PlaneDistance {
    let mut inside = PlaneDistance {
        distance_mm: f64::NEG_INFINITY,
        gradient: DVec2::X,
    };
    let mut outside = PlaneDistance {
        distance_mm: f64::INFINITY,
        gradient: DVec2::X,
    };
    for (index, &from) in corners_mm.iter().enumerate() {
        let edge = corners_mm[(index + 1) % corners_mm.len()] - from;
        let normal = DVec2::new(edge.y, -edge.x).normalize();
        let away = point_mm - from;
        let to_line_mm = away.dot(normal);
        if to_line_mm > inside.distance_mm {
            inside = PlaneDistance {
                distance_mm: to_line_mm,
                gradient: normal,
            };
        }
        let along = away.dot(edge) / edge.length_squared();
        let from_closest = away - along.clamp(0.0, 1.0) * edge;
        let distance_mm = from_closest.length();
        if distance_mm < outside.distance_mm {
            let beside = (0.0..=1.0).contains(&along) || distance_mm < f64::MIN_POSITIVE;
            let gradient = if beside {
                normal * to_line_mm.signum()
            } else {
                from_closest / distance_mm
            };
            outside = PlaneDistance {
                distance_mm,
                gradient,
            };
        }
    }
    if inside.distance_mm <= 0.0 {
        inside
    } else {
        outside
    }
}
