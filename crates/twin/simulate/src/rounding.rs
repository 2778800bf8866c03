//! Radii of curvature of an indenter where it presses. The rims of punches are rounded, and the
//! mesh needs short edges there.

use glam::{DVec2, DVec3};
use twintac_mesh::Stretch;
use twintac_shape::{Pose, SignedDistance};

use crate::touch::underside_mm;

/// Samples on each side of the touched point, along each axis.
const SAMPLES: i32 = 30;

/// Half the distance between the points at which the change of a surface's normal is measured, mm.
/// Sharper edges are not resolved.
const STEP_MM: f64 = 0.05;

/// Smallest radius of curvature of an indenter's underside along x and along y.
pub(crate) struct Roundings {
    step_mm: f64,
    /// At locations one step apart along each axis, the touched point in the middle;
    /// `[2 * SAMPLES + 1]`.
    radius_mm: [Vec<f64>; 2],
}

impl Roundings {
    /// Samples the underside within a radius about the touched point, where a press of this depth
    /// brings it below the surface.
    pub(crate) fn of(
        indenter: &dyn SignedDistance,
        touch: &Pose,
        touched: DVec3,
        within_mm: f64,
        depth_mm: f64,
    ) -> Self {
        let (low, high) = indenter.bounds_mm();
        let reach_mm = low.abs().max(high.abs()).length();
        let ceiling_mm = touched.z - touch.position_mm.z + depth_mm;
        let flat = Pose {
            position_mm: touch.position_mm.with_z(0.0),
            ..*touch
        };
        let normal = |at_mm: DVec3| {
            let inside = flat.inverse_transform_point(at_mm);
            flat.rotation * indenter.signed_distance(inside).gradient
        };
        let step_mm = within_mm / f64::from(SAMPLES);
        let mut radius_mm = [(); 2].map(|()| vec![f64::INFINITY; 2 * SAMPLES as usize + 1]);
        for i in -SAMPLES..=SAMPLES {
            for j in -SAMPLES..=SAMPLES {
                let place = touched.truncate() + step_mm * DVec2::new(f64::from(i), f64::from(j));
                let Some(lowest_mm) = underside_mm(indenter, touch, place, reach_mm, ceiling_mm) else {
                    continue;
                };
                let at_mm = place.extend(lowest_mm);
                for (axis, index) in [i, j].into_iter().enumerate() {
                    let aside_mm = STEP_MM * DVec3::AXES[axis];
                    let turn = normal(at_mm + aside_mm)[axis] - normal(at_mm - aside_mm)[axis];
                    let smallest_mm = &mut radius_mm[axis][(index + SAMPLES) as usize];
                    *smallest_mm = smallest_mm.min(2.0 * STEP_MM / turn.max(1e-9));
                }
            }
        }
        Self { step_mm, radius_mm }
    }

    /// Stretches along x and along y where `edges_per_radius` edges over the radius of curvature
    /// are shorter than `edge_mm`. No edge gets shorter than `shortest_mm`.
    pub(crate) fn stretches(
        &self,
        edges_per_radius: f64,
        [shortest_mm, edge_mm]: [f64; 2],
    ) -> [Vec<Stretch>; 2] {
        [0, 1].map(|axis| {
            (-SAMPLES..)
                .zip(&self.radius_mm[axis])
                .map(|(index, radius_mm)| Stretch {
                    offset_mm: f64::from(index) * self.step_mm,
                    reach_mm: 0.5 * self.step_mm,
                    edge_mm: (radius_mm / edges_per_radius).max(shortest_mm),
                })
                .filter(|stretch| stretch.edge_mm < edge_mm)
                .collect()
        })
    }
}

#[cfg(test)]
mod tests {
    use twintac_shape::{Shape, Surfaces};

    use super::*;

    fn stretches(shape: &Shape) -> [Vec<Stretch>; 2] {
        let indenter = shape.signed_distance_field(&Surfaces::default()).unwrap();
        let touched = DVec3::Z * 8.0;
        Roundings::of(
            indenter.as_ref(),
            &Pose::from_position(touched),
            touched,
            5.5,
            2.0,
        )
        .stretches(2.0, [0.1, 0.7])
    }

    #[test]
    fn a_ball_has_no_rim() {
        assert!(
            stretches(&Shape::Sphere { radius_mm: 12.5 })
                .iter()
                .all(Vec::is_empty)
        );
    }

    #[test]
    fn edges_are_short_across_the_rim_of_a_bar() {
        let bar = Shape::Box {
            size_mm: [3.0, 10.0, 10.0],
            edge_radius_mm: 0.5,
        };
        for (axis, half_width_mm) in stretches(&bar).iter().zip([1.5, 5.0]) {
            let shortest = axis
                .iter()
                .min_by(|a, b| a.edge_mm.total_cmp(&b.edge_mm))
                .unwrap();
            assert!((shortest.edge_mm - 0.25).abs() < 0.03, "{shortest:?}");
            for stretch in axis {
                let inside_mm = half_width_mm - stretch.offset_mm.abs();
                assert!((-0.3..0.8).contains(&inside_mm), "{stretch:?}");
            }
        }
    }
}
