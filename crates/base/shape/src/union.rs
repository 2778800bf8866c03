//! Several shapes joined rigidly.

use glam::DVec3;

use crate::{Distance, Pose, SignedDistance};

/// Shapes with their poses in the frame of the union; at least one.
///
/// Outside, the distance is exact. Inside, it is that to the nearest surface of one of the parts,
/// which is too short where parts overlap.
pub(crate) struct Union {
    parts: Vec<(Pose, Box<dyn SignedDistance>)>,
    bounds_mm: (DVec3, DVec3),
}

impl Union {
    pub(crate) fn new(parts: Vec<(Pose, Box<dyn SignedDistance>)>) -> Self {
        let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (whole_from_part, part) in &parts {
            let (low, high) = part.bounds_mm();
            for corner in 0..8 {
                let pick = |axis: usize| {
                    if corner >> axis & 1 == 0 {
                        low[axis]
                    } else {
                        high[axis]
                    }
                };
                let point = whole_from_part.transform_point(DVec3::new(pick(0), pick(1), pick(2)));
                least = least.min(point);
                most = most.max(point);
            }
        }
        Self {
            parts,
            bounds_mm: (least, most),
        }
    }
}

impl SignedDistance for Union {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        let of_part = |(whole_from_part, part): &(Pose, Box<dyn SignedDistance>)| {
            let found = part.signed_distance(whole_from_part.inverse_transform_point(point_mm));
            Distance {
                gradient: whole_from_part.rotation * found.gradient,
                ..found
            }
        };
        let mut parts = self.parts.iter();
        let first = parts.next().map(of_part).expect("a union has a part");
        parts.map(of_part).fold(first, |nearest, found| {
            if found.distance_mm < nearest.distance_mm {
                found
            } else {
                nearest
            }
        })
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        self.bounds_mm
    }

    fn parts(&self) -> Vec<(Pose, &dyn SignedDistance)> {
        let each = self.parts.iter().flat_map(|(whole_from_part, part)| {
            let within = part.parts();
            let inner = within.into_iter();
            let inner: Vec<_> = inner
                .map(|(pose, part)| (whole_from_part.of(&pose), part))
                .collect();
            if inner.is_empty() {
                vec![(*whole_from_part, part.as_ref())]
            } else {
                inner
            }
        });
        each.collect()
    }
}
