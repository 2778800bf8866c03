//! Frictionless contact of boundary nodes with rigid shapes, known by their signed distance.
//!
//! Augmented Lagrangian (Simo and Laursen, Comput. Struct. 42, 1992): a node with gap `g`, multiplier `λ` and stiffness `κ` adds
//! `(max(0, λ - κ g)² - λ²)/(2κ)` to the energy, and is pushed along the shape's outward normal with `max(0, λ - κ g)`.

use glam::{DMat3, DVec3};
use twintac_shape::{Pose, SignedDistance};

/// Half the distance between the points at which the curvature of a shape is sampled, mm.
const CURVATURE_STEP_MM: f64 = 1e-4;

/// A node that can touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoundaryNode {
    /// Its index.
    pub(crate) node: u32,
    /// Contact stiffness κ, N/mm: a stiffness per area times the boundary area that belongs to the node.
    pub(crate) stiffness: f64,
}

/// A rigid shape where it stands now.
pub(crate) struct RigidBody<'a> {
    pub(crate) shape: &'a dyn SignedDistance,
    pub(crate) gel_from_shape: Pose,
}

/// What one boundary node feels of one shape.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Touch {
    /// Distance to the shape, mm; negative inside. Where the node is surely out of touch, a lower bound above zero.
    pub(crate) gap_mm: f64,
    /// Outward normal of the shape, in the gel's frame.
    pub(crate) normal: DVec3,
    /// Force that pushes the node out, N, not below zero.
    pub(crate) force_n: f64,
    /// Multiplier λ, N.
    pub(crate) multiplier_n: f64,
    /// Where the gap was measured last, in the shape's frame.
    measured_at_mm: DVec3,
    /// What was measured there; a signed distance changes no faster than its point moves.
    measured_mm: f64,
}

impl RigidBody<'_> {
    /// Updates what a node feels where it is now; returns its contact energy, N mm.
    #[inline]
    pub(crate) fn touch(&self, touch: &mut Touch, at_mm: DVec3, stiffness: f64) -> f64 {
        let local_mm = self.gel_from_shape.inverse_transform_point(at_mm);
        let bound_mm = touch.measured_mm - local_mm.distance(touch.measured_at_mm);
        if bound_mm > 0.0 && touch.multiplier_n == 0.0 {
            touch.gap_mm = bound_mm;
            touch.force_n = 0.0;
            return 0.0;
        }
        let distance = self.shape.signed_distance(local_mm);
        touch.measured_at_mm = local_mm;
        touch.measured_mm = distance.distance_mm;
        touch.gap_mm = distance.distance_mm;
        touch.normal = self.gel_from_shape.rotation * distance.gradient;
        touch.force_n = (touch.multiplier_n - stiffness * touch.gap_mm).max(0.0);
        (touch.force_n * touch.force_n - touch.multiplier_n * touch.multiplier_n) / (2.0 * stiffness)
    }

    /// Second derivative of a touching node's contact energy, N/mm: `κ n⊗n - f ∇²d`.
    pub(crate) fn stiffness(
        &self,
        touch: &Touch,
        at_mm: DVec3,
        stiffness: f64,
        with_curvature: bool,
    ) -> DMat3 {
        let normal = touch.normal;
        let mut sum = outer(normal * stiffness, normal);
        if with_curvature {
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
            // Beside an edge the sampled curvature has no bound; the tangent must not lose the contact's own stiffness.
            let size = first.abs().max(second.abs()) + mixed.abs();
            let force = touch.force_n.min(0.5 * stiffness / size.max(1e-12));
            sum -= outer(tangent * first + other * mixed, tangent) * force;
            sum -= outer(tangent * mixed + other * second, other) * force;
        }
        sum
    }
}

impl Touch {
    /// Forgets where the shape was: it has been replaced by another, or there is none yet.
    pub(crate) fn forget_distance(&mut self) {
        self.measured_mm = 0.0;
    }
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
