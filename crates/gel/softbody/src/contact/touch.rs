//! Contact of one point with one shape: gap, force and stiffness.

use glam::{DMat3, DVec3};

use super::point::ContactPoint;
use super::rigid_body::{RigidBody, outer};

/// Depth over which the contact force starts, mm. With a sudden start, Newton's method would
/// alternate between both sides of it.
const RAMP_MM: f64 = 0.001;

/// Half the distance between the points at which the curvature of a shape is sampled, mm.
const CURVATURE_STEP_MM: f64 = 1e-4;

/// Depth beyond the multiplier up to which the curvature of a shape is used, mm: before
/// equilibrium, deep nodes would make the energy concave.
const CURVED_MM: f64 = 0.01;

/// Largest fraction of a contact's stiffness that curvature may remove.
const MOST_CURVED: f64 = 0.05;

/// Contact of one point with one shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// Distance to the shape, mm; negative inside. For a point that is certainly out of contact, a
    /// lower bound above zero.
    pub(crate) gap_mm: f64,
    /// Outward normal of the shape, in the gel's frame.
    pub(crate) normal: DVec3,
    /// Normal force on the point, N; zero or more.
    pub(crate) force_n: f64,
    /// The Lagrange multiplier as a depth, mm: the force of the last update divided by the
    /// stiffness.
    pub(crate) multiplier_mm: f64,
    /// Factor of this contact's stiffness.
    pub(crate) stiffening: f64,
    /// Where the distance was last computed, in the shape's frame.
    measured_at_mm: DVec3,
    /// The distance there, mm. A signed distance changes by at most the distance that its point
    /// moves.
    pub(super) measured_mm: f64,
}

impl Touch {
    /// Out of contact.
    pub(super) const OFF: Self = Self {
        gap_mm: 0.0,
        normal: DVec3::ZERO,
        force_n: 0.0,
        multiplier_mm: 0.0,
        stiffening: 1.0,
        measured_at_mm: DVec3::ZERO,
        measured_mm: 0.0,
    };

    /// Lower bound of the distance of a point in the shape's frame, mm.
    #[inline]
    pub(super) fn bound_mm(&self, local_mm: DVec3) -> f64 {
        self.measured_mm - local_mm.distance(self.measured_at_mm)
    }

    /// Makes the present force the multiplier, for a contact whose stiffness has this factor.
    pub(super) fn update_multiplier(&mut self, stiffening: f64) {
        let multiplier_mm = (self.multiplier_mm - self.gap_mm).max(0.0);
        self.multiplier_mm = multiplier_mm * self.stiffening / stiffening;
        self.stiffening = stiffening;
    }
}

impl RigidBody<'_> {
    /// Updates gap, normal and force of a point at its present position; returns its contact
    /// energy, N mm.
    #[inline]
    pub(crate) fn touch(&self, touch: &mut Touch, point: &ContactPoint, at_mm: DVec3) -> f64 {
        let local_mm = self.gel_from_shape.inverse_transform_point(at_mm);
        let bound_mm = touch.bound_mm(local_mm);
        if bound_mm + point.slack_mm > touch.multiplier_mm {
            touch.gap_mm = bound_mm + point.slack_mm;
            touch.force_n = 0.0;
            return 0.0;
        }
        let (distance_mm, normal) = self.nearest(local_mm);
        touch.measured_at_mm = local_mm;
        touch.measured_mm = distance_mm;
        touch.gap_mm = distance_mm + point.slack_mm;
        touch.normal = normal;
        let stiffness = point.stiffness * touch.stiffening;
        let (energy, force_n, _) = penalty(touch.gap_mm - touch.multiplier_mm, stiffness);
        touch.force_n = force_n;
        energy
    }

    /// Distance of a point from the shape, mm, and the outward direction in the gel's frame.
    #[inline]
    fn nearest(&self, local_mm: DVec3) -> (f64, DVec3) {
        let distance = self.shape.signed_distance(local_mm);
        (
            distance.distance_mm,
            self.gel_from_shape.rotation * distance.gradient,
        )
    }

    /// The outward normal of the shape, in the gel's frame, if a point is nearer to the shape than
    /// `reach_mm`.
    pub(super) fn normal_within(&self, touch: &mut Touch, at_mm: DVec3, reach_mm: f64) -> Option<DVec3> {
        let local_mm = self.gel_from_shape.inverse_transform_point(at_mm);
        if touch.bound_mm(local_mm) >= reach_mm {
            return None;
        }
        let (distance_mm, normal) = self.nearest(local_mm);
        touch.measured_at_mm = local_mm;
        touch.measured_mm = distance_mm;
        (distance_mm < reach_mm).then_some(normal)
    }

    /// Outward normal of the shape at its point nearest to this one, in the gel's frame.
    pub(super) fn normal(&self, at_mm: DVec3) -> DVec3 {
        let local_mm = self.gel_from_shape.inverse_transform_point(at_mm);
        self.gel_from_shape.rotation * self.shape.signed_distance(local_mm).gradient
    }

    /// The force on a point at another position and with another multiplier, N.
    pub(crate) fn push_n(
        &self,
        touch: &Touch,
        point: &ContactPoint,
        at_mm: DVec3,
        multiplier_mm: f64,
    ) -> DVec3 {
        let local_mm = self.gel_from_shape.inverse_transform_point(at_mm);
        let (distance_mm, normal) = self.nearest(local_mm);
        let gap_mm = distance_mm + point.slack_mm;
        let (_, force_n, _) = penalty(gap_mm - multiplier_mm, point.stiffness * touch.stiffening);
        normal * force_n
    }

    /// Second derivative of the contact energy of a point in contact, N/mm: `k n⊗n - f ∇²g`, where
    /// `k` is the slope of the force.
    pub(crate) fn stiffness(&self, touch: &Touch, point: &ContactPoint, at_mm: DVec3) -> DMat3 {
        let normal = touch.normal;
        let stiffness = point.stiffness * touch.stiffening;
        let (_, _, stiffness) = penalty(touch.gap_mm - touch.multiplier_mm, stiffness);
        let mut sum = outer(normal * stiffness, normal);
        // Quadrature points inside of triangles can be deep, near the medial axis of a shape, where
        // normals jump.
        if !point.is_node() {
            return sum;
        }
        let tangent = normal.any_orthonormal_vector();
        let other = normal.cross(tangent);
        let slope = |along: DVec3| {
            let gradient = |sign: f64| {
                let at = self
                    .gel_from_shape
                    .inverse_transform_point(at_mm + along * (sign * CURVATURE_STEP_MM));
                self.gel_from_shape.rotation * self.shape.signed_distance(at).gradient
            };
            (gradient(1.0) - gradient(-1.0)) / (2.0 * CURVATURE_STEP_MM)
        };
        let (along_tangent, along_other) = (slope(tangent), slope(other));
        let mixed = 0.5 * (along_tangent.dot(other) + along_other.dot(tangent));
        let (first, second) = (along_tangent.dot(tangent), along_other.dot(other));
        // Beside a sharp edge the sampled curvature has no bound; the tangent must keep the
        // contact's own stiffness.
        let most = first.max(second) + mixed.abs();
        let usual_mm = touch.multiplier_mm + CURVED_MM;
        let force = touch
            .force_n
            .min(stiffness * usual_mm)
            .min(MOST_CURVED * stiffness / most.max(1e-12));
        sum -= outer(tangent * first + other * mixed, tangent) * force;
        sum -= outer(tangent * mixed + other * second, other) * force;
        sum
    }
}

/// Energy, force and slope of the force at a gap. The force rises with stiffness `κ`, after a
/// quadratic start.
#[inline]
fn penalty(gap_mm: f64, stiffness: f64) -> (f64, f64, f64) {
    let depth_mm = (-gap_mm).max(0.0);
    if depth_mm < RAMP_MM {
        let slope = stiffness * depth_mm / RAMP_MM;
        (slope * depth_mm * depth_mm / 6.0, 0.5 * slope * depth_mm, slope)
    } else {
        let past_mm = depth_mm - 0.5 * RAMP_MM;
        (
            stiffness * (0.5 * past_mm * past_mm + RAMP_MM * RAMP_MM / 24.0),
            stiffness * past_mm,
            stiffness,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_and_slope_are_those_of_the_energy() {
        for gap_mm in [0.1, -0.0002, -0.0009, -0.0011, -0.02] {
            let (_, force, slope) = penalty(gap_mm, 3.0);
            let step = 1e-7;
            let [before, after] = [gap_mm - step, gap_mm + step].map(|gap_mm| penalty(gap_mm, 3.0));
            assert!((force + (after.0 - before.0) / (2.0 * step)).abs() < 1e-8);
            assert!((slope + (after.1 - before.1) / (2.0 * step)).abs() < 1e-6);
        }
    }
}
