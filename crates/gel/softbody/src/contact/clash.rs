//! Checks whether two rigid shapes overlap.

use glam::DVec3;

use super::rigid_body::RigidBody;

/// Depth inside of both shapes up to which they only touch, mm.
const TOUCHING_MM: f64 = 0.02;

/// A point at which two shapes overlap, and the depth there, mm; `None` if they are apart or only
/// touch.
///
/// Boxes are halved until their middle is inside of both shapes, or until no point in them can be:
/// a signed distance changes by at most the distance that its point moves. A moving shape without
/// bounds is not checked.
pub(crate) fn clash(moving: &RigidBody, still: &RigidBody) -> Option<(DVec3, f64)> {
    let (low, high) = moving.shape.bounds_mm();
    let mut boxes = vec![(0.5 * (low + high), 0.5 * (high - low))];
    boxes.retain(|(middle_mm, half_mm)| middle_mm.is_finite() && half_mm.is_finite());
    while let Some((middle_mm, half_mm)) = boxes.pop() {
        let at_mm = moving.gel_from_shape.transform_point(middle_mm);
        let still_mm = still.gel_from_shape.inverse_transform_point(at_mm);
        let gaps_mm = [(moving, middle_mm), (still, still_mm)]
            .map(|(body, at)| body.shape.signed_distance(at).distance_mm);
        let gap_mm = gaps_mm[0].max(gaps_mm[1]);
        if gap_mm < -TOUCHING_MM {
            return Some((at_mm, -gaps_mm[0] - gaps_mm[1]));
        }
        let reach_mm = half_mm.length();
        if gap_mm - reach_mm < -TOUCHING_MM && reach_mm > 0.25 * TOUCHING_MM {
            let axis = half_mm.max_position();
            let mut quarter_mm = DVec3::ZERO;
            quarter_mm[axis] = 0.5 * half_mm[axis];
            boxes.extend([1.0, -1.0].map(|sign| (middle_mm + quarter_mm * sign, half_mm - quarter_mm)));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use twintac_shape::{Pose, Shape, Surfaces};

    use super::*;

    #[test]
    fn a_ball_over_a_wall_is_stopped_where_it_meets_the_rim() {
        let field = |shape: Shape| shape.signed_distance_field(&Surfaces::default()).unwrap();
        let ball = field(Shape::Sphere { radius_mm: 5.0 });
        // A wall from x = 8, up to z = 6, with its rim rounded by 0.5 mm.
        let wall = field(Shape::Box {
            size_mm: [10.0, 40.0, 6.0],
            edge_radius_mm: 0.5,
        });
        let overlap_at = |x_mm: f64, z_mm: f64| {
            let moving = RigidBody {
                shape: ball.as_ref(),
                gel_from_shape: Pose::from_position(DVec3::new(x_mm, 0.0, z_mm)),
            };
            // The wall upside down: the rim is at its lower side.
            let still = RigidBody {
                shape: wall.as_ref(),
                gel_from_shape: Pose {
                    position_mm: DVec3::new(13.0, 0.0, 6.0),
                    rotation: glam::DQuat::from_rotation_y(std::f64::consts::PI),
                },
            };
            clash(&moving, &still).map(|(_, depth_mm)| depth_mm)
        };
        // Its centre is 5.5 mm from that of the rim, at a height of sqrt(5.5² - 4.5²) above that of
        // the rim's centre, 5.5.
        let touch_mm = 5.5 + (5.5_f64 * 5.5 - 4.5 * 4.5).sqrt() - 5.0;
        assert_eq!(overlap_at(4.0, touch_mm + 0.01), None);
        let found_mm = overlap_at(4.0, touch_mm - 0.2).unwrap();
        let deepest_mm = 5.5 - 4.5_f64.hypot(touch_mm - 0.2 + 5.0 - 5.5);
        assert!(
            found_mm > 0.0 && found_mm < deepest_mm + 1e-9,
            "{found_mm} {deepest_mm}"
        );
        assert_eq!(overlap_at(0.0, 4.0), None);
    }
}
