//! How much a shape bends between two points of the boundary.

use glam::DVec3;

use super::rigid_body::RigidBody;

/// Number of parts of the path between which normals are compared.
const N_PARTS: u32 = 8;

impl RigidBody<'_> {
    /// The turn between two normals (the distance of the unit vectors) times the length of the arc
    /// over which the shape turns by as much, mm. This length is that of the whole path if the
    /// shape turns evenly, and shorter if it turns at a rim alone; it is at least one part of the
    /// path.
    pub(super) fn bend_mm(&self, at_mm: [DVec3; 2], normals: [DVec3; 2]) -> f64 {
        let turn = normals[0].distance(normals[1]);
        if turn == 0.0 {
            return 0.0;
        }
        let part = 1.0 / f64::from(N_PARTS);
        let mut sharpest = 0.0;
        let mut before = normals[0];
        for next in 1..=N_PARTS {
            let normal = if next == N_PARTS {
                normals[1]
            } else {
                self.normal(at_mm[0].lerp(at_mm[1], part * f64::from(next)))
            };
            sharpest = f64::max(sharpest, normal.distance(before));
            before = normal;
        }
        // Over one part of the path, the shape turns by `sharpest`.
        let share = turn * part / sharpest;
        turn * at_mm[0].distance(at_mm[1]) * share.min(1.0)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use twintac_shape::{Pose, Shape, Surfaces};

    use super::*;

    /// The bend between two points, with the normals of the shape nearest to them.
    fn bend_mm(shape: &Shape, at_mm: [DVec3; 2]) -> f64 {
        let field = shape.signed_distance_field(&Surfaces::default()).unwrap();
        let body = RigidBody {
            shape: field.as_ref(),
            gel_from_shape: Pose::IDENTITY,
        };
        body.bend_mm(at_mm, at_mm.map(|at_mm| body.normal(at_mm)))
    }

    #[test]
    fn a_ball_bends_all_the_way_and_a_box_at_its_rim() {
        let ball = Shape::Sphere { radius_mm: 5.0 };
        let [a, b] = [DVec3::new(0.0, 0.0, 0.0), DVec3::new(3.0, 0.0, 1.0)];
        // Normals of the ball turn by the chord divided by the radius.
        let chord_mm = a.distance(b);
        let found = bend_mm(&ball, [a, b]);
        let expected = chord_mm * chord_mm / 5.0;
        assert!(found <= expected && found > 0.85 * expected, "{found} {expected}");

        let rounded = |edge_radius_mm: f64| Shape::Box {
            size_mm: [10.0, 10.0, 10.0],
            edge_radius_mm,
        };
        // From 2 mm below the rim to 2 mm beside it: a right angle.
        let across = [DVec3::new(5.0, 0.0, 2.0), DVec3::new(3.0, 0.0, 0.0)];
        let right_angle = std::f64::consts::SQRT_2;
        let sharp = bend_mm(&rounded(0.05), across);
        let way_mm = across[0].distance(across[1]);
        assert!(
            sharp <= right_angle * way_mm / f64::from(N_PARTS) + 1e-9,
            "{sharp}"
        );
        let round = bend_mm(&rounded(0.5), across);
        assert!(
            sharp <= round && round < 0.5 * right_angle * way_mm,
            "{sharp} {round}"
        );
        let flat = bend_mm(&rounded(0.5), [DVec3::ZERO, DVec3::X]);
        assert_eq!(flat, 0.0);
    }
}
