//! Extruded profiles with rounded edges.

use glam::{DVec2, DVec3};

use crate::profile::{PlaneDistance, Profile};
use crate::{Distance, SignedDistance};

/// A profile, extruded to both sides of its plane and then grown by a radius in all directions. For
/// a rounded shape of a given size, the profile is made smaller by the radius first.
#[derive(Clone, Debug)]
pub(crate) struct Prism {
    pub(crate) profile: Profile,
    pub(crate) half_length_mm: f64,
    pub(crate) radius_mm: f64,
    pub(crate) placement: Placement,
}

/// Orientation of a prism in the frame of its shape.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Placement {
    /// The profile lies in the xy plane; the prism stands on z = 0.
    Upright,
    /// The profile's plane is xz; the prism is centred on y = 0.
    Lying,
}

impl Prism {
    fn center_z_mm(&self) -> f64 {
        self.half_length_mm + self.radius_mm
    }
}

impl SignedDistance for Prism {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        match self.placement {
            Placement::Upright => {
                let height_mm = point_mm.z - self.center_z_mm();
                let found = extrude(
                    self.profile.signed_distance(point_mm.truncate()),
                    slab(height_mm, self.half_length_mm),
                );
                Distance {
                    distance_mm: found.distance_mm - self.radius_mm,
                    ..found
                }
            }
            Placement::Lying => {
                let inner = DVec2::new(point_mm.x, point_mm.z);
                let found = extrude(
                    self.profile.signed_distance(inner),
                    slab(point_mm.y, self.half_length_mm),
                );
                let DVec3 { x, y, z } = found.gradient;
                Distance {
                    distance_mm: found.distance_mm - self.radius_mm,
                    gradient: DVec3::new(x, z, y),
                }
            }
        }
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        let (low, high) = self.profile.bounds_mm();
        let reach_mm = self.half_length_mm + self.radius_mm;
        let (low, high) = (low - self.radius_mm, high + self.radius_mm);
        match self.placement {
            Placement::Upright => (low.extend(0.0), high.extend(2.0 * reach_mm)),
            Placement::Lying => (
                DVec3::new(low.x, -reach_mm, low.y),
                DVec3::new(high.x, reach_mm, high.y),
            ),
        }
    }
}

/// Distance to a slab of the given half thickness about 0, and the sign of its gradient.
fn slab(height_mm: f64, half_mm: f64) -> (f64, f64) {
    (
        height_mm.abs() - half_mm,
        if height_mm > 0.0 { 1.0 } else { -1.0 },
    )
}

/// Distance to the intersection of an infinite prism (a profile extruded along z) and a slab
/// between two levels. It is exact, because the two are orthogonal.
pub(crate) fn extrude(profile: PlaneDistance, (level_mm, level_sign): (f64, f64)) -> Distance {
    let aside = profile.gradient.extend(0.0);
    let along = DVec3::Z * level_sign;
    if profile.distance_mm > 0.0 && level_mm > 0.0 {
        let distance_mm = profile.distance_mm.hypot(level_mm);
        let gradient =
            (aside * (profile.distance_mm / distance_mm) + along * (level_mm / distance_mm)).normalize();
        Distance {
            distance_mm,
            gradient,
        }
    } else if profile.distance_mm > level_mm {
        Distance {
            distance_mm: profile.distance_mm,
            gradient: aside,
        }
    } else {
        Distance {
            distance_mm: level_mm,
            gradient: along,
        }
    }
}
