//! Where an indenter first touches the undeformed gel, and the radius of its contact.

use glam::{DVec2, DVec3};
use twintac_shape::{Pose, SignedDistance};

/// Samples along each axis of the search. The second search refines around the best sample of the
/// first one.
const SAMPLES: i32 = 40;

/// Heights that differ by less than this count as equal, mm.
const SAME_HEIGHT_MM: f64 = 1e-6;

/// The pose at which an indenter that moves straight down above `(x_mm, y_mm)` touches the gel,
/// with the touched point. `top_height_mm` gives the height of the gel's top, `None` beside the
/// gel. `None` if the indenter misses the gel.
pub(crate) fn first_touch(
    indenter: &dyn SignedDistance,
    at_origin: &Pose,
    top_height_mm: &dyn Fn(f64, f64) -> Option<f64>,
) -> Option<(Pose, DVec3)> {
    let place = at_origin.position_mm.truncate();
    let (low, high) = indenter.bounds_mm();
    let reach_mm = low.abs().max(high.abs()).length();
    let mut centre = place;
    let mut best_mm = f64::NEG_INFINITY;
    for half_width_mm in [
        reach_mm,
        reach_mm / f64::from(SAMPLES),
        reach_mm / f64::from(SAMPLES * SAMPLES),
    ] {
        // Of all points that touch at once, such as those under a flat punch, the middle counts.
        let (mut sum, mut count) = (DVec2::ZERO, 0.0);
        for i in -SAMPLES..=SAMPLES {
            for j in -SAMPLES..=SAMPLES {
                let offset = DVec2::new(f64::from(i), f64::from(j)) * (half_width_mm / f64::from(SAMPLES));
                let point = centre + offset;
                let Some(height_mm) = top_height_mm(point.x, point.y) else {
                    continue;
                };
                // No underside above this height touches earlier than the best so far.
                let ceiling_mm = (height_mm - best_mm + SAME_HEIGHT_MM).min(1.5 * reach_mm);
                let Some(lowest_mm) = underside_mm(indenter, at_origin, point, reach_mm, ceiling_mm) else {
                    continue;
                };
                let z_mm = height_mm - lowest_mm;
                if z_mm > best_mm + SAME_HEIGHT_MM {
                    (sum, count) = (DVec2::ZERO, 0.0);
                }
                best_mm = best_mm.max(z_mm);
                sum += point;
                count += 1.0;
            }
        }
        if count > 0.0 {
            centre = sum / count;
        }
    }
    let height_mm = top_height_mm(centre.x, centre.y)?;
    best_mm.is_finite().then(|| {
        let pose = Pose {
            position_mm: place.extend(best_mm),
            rotation: at_origin.rotation,
        };
        (pose, centre.extend(height_mm))
    })
}

/// Height of the indenter's underside above its origin at a location in the gel's plane, mm. `None`
/// beside the indenter, and where the underside is above the ceiling.
pub(crate) fn underside_mm(
    indenter: &dyn SignedDistance,
    pose: &Pose,
    place: DVec2,
    reach_mm: f64,
    ceiling_mm: f64,
) -> Option<f64> {
    let flat = Pose {
        position_mm: pose.position_mm.truncate().extend(0.0),
        rotation: pose.rotation,
    };
    let mut z_mm = -1.5 * reach_mm;
    for _ in 0..200 {
        let distance_mm = indenter
            .signed_distance(flat.inverse_transform_point(place.extend(z_mm)))
            .distance_mm;
        if distance_mm < 1e-9 {
            return Some(z_mm);
        }
        z_mm += distance_mm;
        if z_mm > ceiling_mm {
            return None;
        }
    }
    // Rays that graze a side advance slowly. What is not hit by now touches later than its
    // neighbours.
    None
}

/// Radius in the gel's plane, about the touched point, of the part of the indenter that a press of
/// this depth brings below the surface, mm.
pub(crate) fn contact_radius_mm(
    indenter: &dyn SignedDistance,
    gel_from_indenter_at_touch: &Pose,
    touched: DVec3,
    depth_mm: f64,
) -> f64 {
    let (low, high) = indenter.bounds_mm();
    let reach_mm = low.abs().max(high.abs()).length();
    // A plate may lie wholly below the surface, so it is searched for at all heights.
    let goes_below = |place: DVec3| {
        let mut above_mm = 0.0;
        while above_mm <= depth_mm {
            let point = gel_from_indenter_at_touch.inverse_transform_point(place + DVec3::Z * above_mm);
            let distance_mm = indenter.signed_distance(point).distance_mm;
            if distance_mm <= 0.0 {
                return true;
            }
            above_mm += distance_mm.max(SAME_HEIGHT_MM.max(1e-3 * depth_mm));
        }
        false
    };
    let mut radius_mm: f64 = 0.0;
    for i in -SAMPLES..=SAMPLES {
        for j in -SAMPLES..=SAMPLES {
            let offset = DVec2::new(f64::from(i), f64::from(j)) * (reach_mm / f64::from(SAMPLES));
            if offset.length() > radius_mm && goes_below(touched + offset.extend(0.0)) {
                radius_mm = offset.length();
            }
        }
    }
    radius_mm.max(reach_mm / f64::from(SAMPLES))
}
