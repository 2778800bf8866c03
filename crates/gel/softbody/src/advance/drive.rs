//! What moves in a step: an indenter, or the bonded nodes.

use glam::DVec3;
use twintac_shape::{Pose, SignedDistance};

use crate::body::SoftBody;

/// Fraction of its smallest dimension by which an indenter may move in one step.
const THICKNESS_PART: f64 = 0.25;

/// A motion of the indenter, or of the bonded nodes.
pub(super) enum Drive<'a> {
    Indenter {
        shape: &'a dyn SignedDistance,
        from: Pose,
        to: Pose,
    },
    Bonded {
        from: Vec<DVec3>,
        to: &'a [DVec3],
    },
}

impl Drive<'_> {
    pub(super) fn pose(&self, fraction: f64) -> Pose {
        match self {
            Self::Indenter { from, to, .. } if fraction < 1.0 => Pose {
                position_mm: from.position_mm.lerp(to.position_mm, fraction),
                rotation: from.rotation.slerp(to.rotation, fraction),
            },
            Self::Indenter { to, .. } => *to,
            Self::Bonded { .. } => Pose::IDENTITY,
        }
    }

    /// Travel of the indenter between two fractions of the motion, mm. For bonded nodes it is in a
    /// direction of its own, so that a part of their motion is extrapolated from the part before.
    pub(super) fn travel_mm(&self, [from, to]: [f64; 2]) -> DVec3 {
        match self {
            Self::Indenter { .. } => self.pose(to).position_mm - self.pose(from).position_mm,
            Self::Bonded { .. } => (to - from) * DVec3::X,
        }
    }

    /// Largest fraction of the motion for one step: a node inside of the moved shape must still be
    /// nearest to the side through which it entered.
    pub(super) fn largest_part(&self, max_travel_mm: f64) -> f64 {
        let Self::Indenter { shape, from, to } = self else {
            return 1.0;
        };
        let (low, high) = shape.bounds_mm();
        let travel_mm = way_mm(*shape, from, to);
        let limit_mm = max_travel_mm.min(THICKNESS_PART * (high - low).min_element());
        if travel_mm > limit_mm && limit_mm > 0.0 {
            1.0 / (travel_mm / limit_mm).ceil()
        } else {
            1.0
        }
    }

    /// Way that is left at a fraction of the motion, mm; 0 for bonded nodes.
    pub(super) fn left_mm(&self, fraction: f64) -> f64 {
        match self {
            Self::Indenter { shape, to, .. } => way_mm(*shape, &self.pose(fraction), to),
            Self::Bonded { .. } => 0.0,
        }
    }

    pub(super) fn shape(&self) -> &dyn SignedDistance {
        match self {
            Self::Indenter { shape, .. } => *shape,
            Self::Bonded { .. } => &Nothing,
        }
    }

    /// Moves the bonded nodes to their positions at a fraction of the motion.
    pub(super) fn hold(&self, body: &SoftBody, fraction: f64, displacements_mm: &mut [DVec3]) {
        if let Self::Bonded { from, to } = self {
            for ((&node, from), to) in body.mesh().sets.bonded.iter().zip(from).zip(*to) {
                displacements_mm[node as usize] = from.lerp(*to, fraction);
            }
        }
    }
}

/// Way of a shape from one pose to another, mm, with the way of its farthest point in a turn.
pub(super) fn way_mm(shape: &dyn SignedDistance, from: &Pose, to: &Pose) -> f64 {
    // The angle between equal rotations need not be zero.
    if from == to {
        return 0.0;
    }
    let (low, high) = shape.bounds_mm();
    let reach_mm = low.abs().max(high.abs()).length();
    let turn = from.rotation.angle_between(to.rotation);
    from.position_mm.distance(to.position_mm) + turn * reach_mm
}

/// A shape that is nowhere.
struct Nothing;

impl SignedDistance for Nothing {
    fn signed_distance(&self, _: DVec3) -> twintac_shape::Distance {
        twintac_shape::Distance {
            distance_mm: f64::MAX,
            gradient: DVec3::Z,
        }
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        (DVec3::ZERO, DVec3::ZERO)
    }
}
