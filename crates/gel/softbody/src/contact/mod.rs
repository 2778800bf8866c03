//! Contact of a boundary with rigid shapes, known by their signed distance: of its nodes, and of places inside its triangles.
//!
//! A place with gap `g` and a carried depth `c` adds about `κ (c - g)²/2` to the energy where `g < c`, and is pushed along the shape's outward
//! normal with about `κ (c - g)`. With every step that ends well contacts carry on: `c` becomes `c - g`, so that the force is there without
//! any penetration (augmented Lagrangian; Hestenes, J. Optim. Theory Appl. 4, 1969), and what penetration is left comes from the last
//! step alone. In a hollow corner of a shape the direction of its nearest side jumps, and there is no equilibrium to be found: walls that
//! meet are better given as shapes of their own, of which a node in the corner touches two.

mod clash;
mod friction;
mod inside;
mod point;

pub(crate) use clash::clash;
pub(crate) use friction::Friction;
pub(crate) use inside::{BoundaryTriangle, Inside};
pub(crate) use point::{Boundary, ContactPoint};

use std::collections::BTreeSet;

use glam::{DMat3, DVec3};
use twintac_shape::{Pose, SignedDistance};

/// Depth over which the force of contact starts, mm. A sudden start would leave Newton's method going to and fro across it.
const RAMP_MM: f64 = 0.001;

/// Half the distance between the points at which the curvature of a shape is sampled, mm.
const CURVATURE_STEP_MM: f64 = 1e-4;

/// Depth past the carried one beyond which the curvature of a shape counts no more, mm: before equilibrium, deep nodes would make the energy bend down.
const CURVED_MM: f64 = 0.01;

/// Most that curvature takes of a contact's stiffness.
const MOST_CURVED: f64 = 0.05;

/// How much stiffer a contact is made that carrying its force over does not push out,
const STIFFENING: f64 = 4.0;

/// which is one that leaves more than this part of the depth.
const STUCK: f64 = 0.5;

/// A rigid shape where it stands now.
pub(crate) struct RigidBody<'a> {
    pub(crate) shape: &'a dyn SignedDistance,
    pub(crate) gel_from_shape: Pose,
}

/// What one place feels of one shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// Distance to the shape, mm; negative inside. Where the place is surely out of touch, a lower bound above zero.
    pub(crate) gap_mm: f64,
    /// Outward normal of the shape, in the gel's frame.
    pub(crate) normal: DVec3,
    /// Force that pushes the place out, N, not below zero.
    pub(crate) force_n: f64,
    /// Depth that stands for the force carried over from before, mm.
    pub(crate) carried_mm: f64,
    /// By how much this contact is stiffer than usual.
    pub(crate) stiffening: f64,
    /// Where the gap was measured last, in the shape's frame.
    measured_at_mm: DVec3,
    /// What was measured there; a signed distance changes no faster than its point moves.
    measured_mm: f64,
}

/// What the boundary feels of one shape.
#[derive(Debug)]
pub(crate) struct Contact {
    /// Of its nodes. `[n_boundary_nodes]`
    pub(crate) touches: Vec<Touch>,
    /// The places inside its triangles that are watched.
    inside: Vec<Inside>,
    /// Depth of the deepest node when nodes were last pushed out in this step, mm.
    pushed_mm: f64,
    /// None for a coefficient of zero.
    pub(crate) friction: Option<Friction>,
}

impl Touch {
    /// Out of touch.
    const OFF: Self = Self {
        gap_mm: 0.0,
        normal: DVec3::ZERO,
        force_n: 0.0,
        carried_mm: 0.0,
        stiffening: 1.0,
        measured_at_mm: DVec3::ZERO,
        measured_mm: 0.0,
    };

    /// Least distance that a point in the shape's frame can have, mm.
    #[inline]
    fn bound_mm(&self, local_mm: DVec3) -> f64 {
        self.measured_mm - local_mm.distance(self.measured_at_mm)
    }

    /// Gives another stiffness to a force that is carried over.
    fn carry(&mut self, stiffening: f64) {
        let carried_mm = (self.carried_mm - self.gap_mm).max(0.0);
        self.carried_mm = carried_mm * self.stiffening / stiffening;
        self.stiffening = stiffening;
    }
}

impl RigidBody<'_> {
    /// Updates what a point feels where it is now; returns its contact energy, N mm.
    #[inline]
    pub(crate) fn touch(&self, touch: &mut Touch, point: &ContactPoint, at_mm: DVec3) -> f64 {
        let local_mm = self.gel_from_shape.inverse_transform_point(at_mm);
        let bound_mm = touch.bound_mm(local_mm);
        if bound_mm + point.slack_mm > touch.carried_mm {
            touch.gap_mm = bound_mm + point.slack_mm;
            touch.force_n = 0.0;
            return 0.0;
        }
        let distance = self.shape.signed_distance(local_mm);
        touch.measured_at_mm = local_mm;
        touch.measured_mm = distance.distance_mm;
        touch.gap_mm = distance.distance_mm + point.slack_mm;
        touch.normal = self.gel_from_shape.rotation * distance.gradient;
        let stiffness = point.stiffness * touch.stiffening;
        let (energy, force_n, _) = penalty(touch.gap_mm - touch.carried_mm, stiffness);
        touch.force_n = force_n;
        energy
    }

    /// Whether a point is nearer than this to the shape.
    fn is_within(&self, touch: &mut Touch, at_mm: DVec3, reach_mm: f64) -> bool {
        let local_mm = self.gel_from_shape.inverse_transform_point(at_mm);
        if touch.bound_mm(local_mm) >= reach_mm {
            return false;
        }
        touch.measured_at_mm = local_mm;
        touch.measured_mm = self.shape.signed_distance(local_mm).distance_mm;
        touch.measured_mm < reach_mm
    }

    /// Outward normal of the shape at its place nearest to a point, in the gel's frame.
    fn normal(&self, at_mm: DVec3) -> DVec3 {
        let local_mm = self.gel_from_shape.inverse_transform_point(at_mm);
        self.gel_from_shape.rotation * self.shape.signed_distance(local_mm).gradient
    }

    /// The force on a point with what it felt before, were its place and the depth that it carries others, N.
    pub(crate) fn push_n(&self, touch: &Touch, point: &ContactPoint, at_mm: DVec3, carried_mm: f64) -> DVec3 {
        let distance = self
            .shape
            .signed_distance(self.gel_from_shape.inverse_transform_point(at_mm));
        let gap_mm = distance.distance_mm + point.slack_mm;
        let (_, force_n, _) = penalty(gap_mm - carried_mm, point.stiffness * touch.stiffening);
        self.gel_from_shape.rotation * distance.gradient * force_n
    }

    /// Second derivative of a touching point's contact energy, N/mm: `k n⊗n - f ∇²g`, `k` the slope of the force.
    pub(crate) fn stiffness(&self, touch: &Touch, point: &ContactPoint, at_mm: DVec3) -> DMat3 {
        let normal = touch.normal;
        let stiffness = point.stiffness * touch.stiffening;
        let (_, _, stiffness) = penalty(touch.gap_mm - touch.carried_mm, stiffness);
        let mut sum = outer(normal * stiffness, normal);
        // Places inside triangles are deep where shapes have their middle, and normals jump.
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
        // Beside a sharp edge the sampled curvature has no bound; the tangent must not lose the contact's own stiffness.
        let most = first.max(second) + mixed.abs();
        let usual_mm = touch.carried_mm + CURVED_MM;
        let force = touch
            .force_n
            .min(stiffness * usual_mm)
            .min(MOST_CURVED * stiffness / most.max(1e-12));
        sum -= outer(tangent * first + other * mixed, tangent) * force;
        sum -= outer(tangent * mixed + other * second, other) * force;
        sum
    }
}

impl Clone for Contact {
    fn clone(&self) -> Self {
        Self {
            touches: self.touches.clone(),
            inside: self.inside.clone(),
            pushed_mm: self.pushed_mm,
            friction: self.friction.clone(),
        }
    }

    /// Without new memory: every step begins with it.
    fn clone_from(&mut self, source: &Self) {
        self.touches.clone_from(&source.touches);
        self.inside.clone_from(&source.inside);
        self.pushed_mm = source.pushed_mm;
        self.friction.clone_from(&source.friction);
    }
}

impl Contact {
    /// No contact yet.
    pub(crate) fn new(n_boundary_nodes: usize, friction: f64) -> Self {
        Self {
            touches: vec![Touch::OFF; n_boundary_nodes],
            inside: Vec::new(),
            pushed_mm: f64::INFINITY,
            friction: (friction > 0.0).then(|| Friction::new(friction, n_boundary_nodes)),
        }
    }

    /// All points, and what they feel.
    pub(crate) fn each<'a>(
        &'a self,
        boundary: &'a Boundary,
    ) -> impl Iterator<Item = (&'a ContactPoint, &'a Touch)> {
        let inside = self.inside.iter().map(|inside| (&inside.point, &inside.touch));
        boundary.nodes.iter().zip(&self.touches).chain(inside)
    }

    /// The same, to be changed.
    pub(crate) fn each_mut<'a>(
        &'a mut self,
        boundary: &'a Boundary,
    ) -> impl Iterator<Item = (&'a ContactPoint, &'a mut Touch)> {
        let inside = self.inside.iter_mut();
        let inside = inside.map(|inside| (&inside.point, &mut inside.touch));
        boundary.nodes.iter().zip(&mut self.touches).chain(inside)
    }

    /// All points, and the force of the shape on each, N.
    pub(crate) fn forces_n<'a>(
        &'a self,
        boundary: &'a Boundary,
    ) -> impl Iterator<Item = (&'a ContactPoint, DVec3)> {
        self.each(boundary).enumerate().map(|(index, (point, touch))| {
            let pushed_n = touch.normal * touch.force_n;
            let friction = self.friction.as_ref().filter(|_| index < boundary.nodes.len());
            let force_n = friction.map_or(pushed_n, |friction| pushed_n + friction.force_n(index));
            (point, force_n)
        })
    }

    /// Free nodes that the shape presses, themselves or beside them, ascending.
    pub(crate) fn pressed_nodes(&self, boundary: &Boundary, n_free: usize) -> BTreeSet<u32> {
        let pressed = self.each(boundary).filter(|(_, touch)| touch.force_n > 0.0);
        let nodes = pressed.flat_map(|(point, _)| point.parts().map(|(node, _)| node));
        nodes.filter(|&node| (node as usize) < n_free).collect()
    }

    /// Carries the forces as they are over to the next step.
    pub(crate) fn carry(&mut self) {
        self.touches.iter_mut().for_each(|touch| touch.carry(1.0));
        self.pushed_mm = f64::INFINITY;
    }

    /// Carries the forces over within a step if nodes are deeper than allowed; true if there are any. Where that helps no more they are made
    /// stiffer: neighbours on a hilltop would take turns at slipping off.
    pub(crate) fn push_out(&mut self, allowed_mm: f64) -> bool {
        let deepest_mm = self.penetration_mm();
        if deepest_mm <= allowed_mm {
            return false;
        }
        let is_stuck = deepest_mm > STUCK * self.pushed_mm;
        self.pushed_mm = deepest_mm;
        for touch in &mut self.touches {
            let is_deep = is_stuck && touch.gap_mm < -allowed_mm;
            touch.carry(touch.stiffening * if is_deep { STIFFENING } else { 1.0 });
        }
        true
    }

    /// Carries nothing over.
    pub(crate) fn drop_carried(&mut self) {
        self.touches.iter_mut().for_each(|touch| touch.carried_mm = 0.0);
    }

    /// Depth of the deepest node, mm.
    pub(crate) fn penetration_mm(&self) -> f64 {
        self.touches
            .iter()
            .fold(0.0, |deepest, touch| f64::max(deepest, -touch.gap_mm))
    }

    /// Forgets what was measured: the shape may be another now.
    pub(crate) fn forget_distances(&mut self) {
        self.touches.iter_mut().for_each(|touch| touch.measured_mm = 0.0);
    }
}

/// Energy, force and slope of the force at a gap: the force rises with stiffness `κ`, after a quadratic start.
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

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
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
