//! Coulomb friction of a boundary's nodes on a rigid shape.
//!
//! A node in contact is connected to a point of the shape, its anchor, by a spring along the
//! surface. The force of the spring is at most the coefficient times the normal force, `μ f`. It
//! grows from the stiffness `k` to that limit over a slip of `2 μ f / k`, and drags the anchor
//! along beyond that (Simo and Laursen, Comput. Struct. 42, 1992). It is `μ f (2t - t²)`, where `t`
//! is the fraction of that slip. With a kink at the limit, Newton's method would alternate between
//! nodes that stick and nodes that slip.
//!
//! With the normal forces of the last iterate ("lagged"), the spring has an energy and a symmetric
//! tangent, and never returns more energy than it took; both ideas are of Li et al. (Incremental
//! Potential Contact, ACM Trans. Graph. 39, 2020). The anchor of a spring that sticks does not
//! move, so a held press does not creep.

use glam::{DMat3, DVec3};

use super::point::ContactPoint;
use super::rigid_body::{RigidBody, outer};
use super::touch::Touch;

/// A node within this distance of the shape is in contact with it, mm.
const STANDING_MM: f64 = 0.001;

/// Friction of a boundary's nodes on one shape.
#[derive(Clone, Debug)]
pub(crate) struct Friction {
    coefficient: f64,
    /// `[n_boundary_nodes]`
    grips: Vec<Grip>,
}

/// The friction of one node.
#[derive(Clone, Copy, Debug, Default)]
struct Grip {
    /// The anchor of the node, in the shape's frame. `None` if the node was off the shape when the
    /// step began: its first contact is without friction, because it is unknown for which part of
    /// the step it is in contact.
    anchor_mm: Option<DVec3>,
    /// Outward normal of the shape; and below, the largest force of the spring, N. Both are those
    /// of the last iterate.
    normal: DVec3,
    most_n: f64,
    /// Force on the node, N.
    force_n: DVec3,
}

impl Friction {
    /// Friction without any anchor.
    pub(crate) fn new(coefficient: f64, n_boundary_nodes: usize) -> Self {
        Self {
            coefficient,
            grips: vec![Grip::default(); n_boundary_nodes],
        }
    }

    /// Begins a step: nodes that are in contact with the shape, at its pose before the step, get an
    /// anchor.
    pub(crate) fn begin<'a>(
        &mut self,
        shape: &RigidBody,
        touches: &[Touch],
        nodes: impl Iterator<Item = (&'a ContactPoint, DVec3)>,
    ) {
        for ((grip, touch), (_, at_mm)) in self.grips.iter_mut().zip(touches).zip(nodes) {
            if grip.anchor_mm.is_none() && touch.gap_mm <= STANDING_MM {
                let local_mm = shape.gel_from_shape.inverse_transform_point(at_mm);
                let distance_mm = shape.shape.signed_distance(local_mm).distance_mm;
                grip.anchor_mm = (distance_mm <= STANDING_MM).then_some(local_mm);
            }
        }
    }

    /// Whether no node has an anchor.
    pub(crate) fn holds_nothing(&self) -> bool {
        self.grips
            .iter()
            .all(|grip| grip.anchor_mm.is_none() && grip.most_n <= 0.0)
    }

    /// Updates normals and normal forces; returns the sum of the changes of the springs' limits, N.
    pub(crate) fn follow(&mut self, touches: &[Touch]) -> f64 {
        let mut change_n = 0.0;
        for (grip, touch) in self.grips.iter_mut().zip(touches) {
            if grip.anchor_mm.is_some() {
                let most_n = self.coefficient * touch.force_n;
                change_n += (most_n - grip.most_n).abs();
                (grip.normal, grip.most_n) = (touch.normal, most_n);
            }
        }
        change_n
    }

    /// Updates the force on each node with an anchor and passes it to `add`; returns the energy, N
    /// mm.
    pub(crate) fn pull<'a>(
        &mut self,
        shape: &RigidBody,
        nodes: impl Iterator<Item = (&'a ContactPoint, DVec3)>,
        mut add: impl FnMut(&ContactPoint, DVec3),
    ) -> f64 {
        let mut energy = 0.0;
        for (grip, (point, at_mm)) in self.grips.iter_mut().zip(nodes) {
            grip.force_n = DVec3::ZERO;
            if grip.most_n > 0.0
                && let Some(slip_mm) = grip.slip_mm(shape, at_mm)
            {
                let length_mm = slip_mm.length();
                let elastic_mm = grip.elastic_mm(point.stiffness);
                let part = length_mm / elastic_mm;
                if part <= 1.0 {
                    energy += grip.most_n * length_mm * part * (1.0 - part / 3.0);
                    grip.force_n = -slip_mm * (grip.most_n / elastic_mm) * (2.0 - part);
                } else {
                    energy += grip.most_n * (length_mm - elastic_mm / 3.0);
                    grip.force_n = -slip_mm * (grip.most_n / length_mm);
                }
                add(point, grip.force_n);
            }
        }
        energy
    }

    /// Second derivative of the energy at a boundary node, N/mm; `None` if the node has no anchor.
    pub(crate) fn stiffness(
        &self,
        index: usize,
        shape: &RigidBody,
        at_mm: DVec3,
        stiffness: f64,
    ) -> Option<DMat3> {
        let grip = &self.grips[index];
        let slip_mm = grip.slip_mm(shape, at_mm).filter(|_| grip.most_n > 0.0)?;
        let (length_mm, elastic_mm) = (slip_mm.length(), grip.elastic_mm(stiffness));
        let plane = DMat3::IDENTITY - outer(grip.normal, grip.normal);
        let along = slip_mm.normalize_or_zero();
        let part = length_mm / elastic_mm;
        Some(if part <= 1.0 {
            (plane * (2.0 - part) - outer(along, along) * part) * (grip.most_n / elastic_mm)
        } else {
            (plane - outer(along, along)) * (grip.most_n / length_mm)
        })
    }

    /// Ends a step: nodes that slipped have dragged their anchors along, and nodes that left the
    /// shape lose theirs.
    pub(crate) fn settle<'a>(
        &mut self,
        shape: &RigidBody,
        touches: &[Touch],
        nodes: impl Iterator<Item = (&'a ContactPoint, DVec3)>,
    ) {
        for ((grip, touch), (point, at_mm)) in self.grips.iter_mut().zip(touches).zip(nodes) {
            if touch.force_n <= 0.0 {
                *grip = Grip::default();
                continue;
            }
            (grip.normal, grip.most_n) = (touch.normal, self.coefficient * touch.force_n);
            let held_mm = grip
                .slip_mm(shape, at_mm)
                .unwrap_or(DVec3::ZERO)
                .clamp_length_max(grip.elastic_mm(point.stiffness));
            grip.anchor_mm = Some(shape.gel_from_shape.inverse_transform_point(at_mm - held_mm));
        }
    }

    /// Force on a boundary node, N.
    pub(crate) fn force_n(&self, index: usize) -> DVec3 {
        self.grips[index].force_n
    }
}

impl Grip {
    /// Distance of the node from its anchor along the surface, mm; `None` without an anchor.
    fn slip_mm(&self, shape: &RigidBody, at_mm: DVec3) -> Option<DVec3> {
        let anchor_mm = shape.gel_from_shape.transform_point(self.anchor_mm?);
        Some((at_mm - anchor_mm).reject_from_normalized(self.normal))
    }

    /// Slip at which the spring's force reaches its limit, mm; `stiffness` is that without slip,
    /// N/mm.
    fn elastic_mm(&self, stiffness: f64) -> f64 {
        2.0 * self.most_n / stiffness
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use twintac_shape::{Pose, Shape, Surfaces};

    use super::*;

    const STIFFNESS: f64 = 50.0;

    /// One node that a resting ball holds at the origin with at most 0.2 N.
    fn held() -> Friction {
        let grip = Grip {
            anchor_mm: Some(DVec3::ZERO),
            normal: DVec3::Z,
            most_n: 0.2,
            force_n: DVec3::ZERO,
        };
        Friction {
            coefficient: 0.5,
            grips: vec![grip],
        }
    }

    fn on_ball<T>(make: impl FnOnce(&RigidBody) -> T) -> T {
        let ball = Shape::Sphere { radius_mm: 5.0 };
        let ball = ball.signed_distance_field(&Surfaces::default()).unwrap();
        make(&RigidBody {
            shape: &*ball,
            gel_from_shape: Pose::IDENTITY,
        })
    }

    fn energy_and_force(at_mm: DVec3) -> (f64, DVec3) {
        let (mut friction, point) = (held(), ContactPoint::of_node(0, STIFFNESS));
        let energy = on_ball(|ball| friction.pull(ball, std::iter::once((&point, at_mm)), |_, _| ()));
        (energy, friction.force_n(0))
    }

    #[test]
    fn force_and_stiffness_are_those_of_the_energy() {
        let elastic_mm = held().grips[0].elastic_mm(STIFFNESS);
        let step = 1e-7;
        for slip_mm in [0.0, 0.3, 0.999, 1.001, 3.0].map(|part| part * elastic_mm) {
            let at_mm = DVec3::new(0.6, -0.8, 0.0) * slip_mm + 0.01 * DVec3::Z;
            let stiffness = on_ball(|ball| held().stiffness(0, ball, at_mm, STIFFNESS)).unwrap();
            let force_n = energy_and_force(at_mm).1;
            assert!(force_n.length() <= 0.2 * (1.0 + 1e-12));
            for axis in DVec3::AXES {
                let [before, after] = [-step, step].map(|by| energy_and_force(at_mm + by * axis));
                let slope = (after.0 - before.0) / (2.0 * step);
                assert!(
                    (slope + force_n.dot(axis)).abs() < 1e-7,
                    "{slip_mm} mm along {axis}"
                );
                let change = (before.1 - after.1) / (2.0 * step);
                let off = (change - stiffness * axis).length();
                assert!(off < 2e-3 * STIFFNESS, "{slip_mm} mm along {axis}: {off} N/mm");
            }
        }
    }

    #[test]
    fn the_limit_is_reached_without_a_kink() {
        let elastic_mm = held().grips[0].elastic_mm(STIFFNESS);
        let along = |slip_mm: f64| {
            let at_mm = slip_mm * DVec3::X;
            on_ball(|ball| held().stiffness(0, ball, at_mm, STIFFNESS))
                .unwrap()
                .x_axis
                .x
        };
        assert_eq!(along(0.0), STIFFNESS);
        assert!(along(0.9999 * elastic_mm) < 1e-3 * STIFFNESS);
        assert_eq!(along(1.0001 * elastic_mm), 0.0);
    }
}
