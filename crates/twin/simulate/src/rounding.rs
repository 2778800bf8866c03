//! Radii of curvature of an indenter where it presses. The rims of punches are rounded, and the
//! mesh needs short edges there, and a line where the rounding begins.

use glam::{DVec2, DVec3};
use twintac_mesh::Stretch;
use twintac_shape::{Pose, SignedDistance};

use crate::touch::underside_mm;

/// Samples on each side of the touched point, along each axis.
const SAMPLES: i32 = 30;

/// Half the distance between the points at which the change of a surface's normal is measured, mm.
/// Sharper edges are not resolved.
const STEP_MM: f64 = 0.05;

/// An underside with a larger radius of curvature counts as flat, mm.
const FLAT_MM: f64 = 100.0;

/// Number of halvings of the distance between two samples to find where a flat ends.
const HALVINGS: usize = 8;

/// Smallest radius of curvature of an indenter's underside along x and along y.
pub(crate) struct Roundings {
    step_mm: f64,
    /// At locations one step apart along each axis, the touched point in the middle;
    /// `[2 * SAMPLES + 1]`. Infinite where there is no underside.
    radius_mm: [Vec<f64>; 2],
    flat_ends: [Vec<FlatEnd>; 2],
}

/// Where a flat underside ends and a rounding begins along an axis.
#[derive(Clone, Copy, Debug)]
struct FlatEnd {
    /// Relative to the touched point, mm.
    offset_mm: f64,
    /// Smallest radius of curvature beyond, mm.
    radius_mm: f64,
}

/// Where a mesh needs short edges and lines of its own, along x and along y.
#[derive(Clone, Default)]
pub(crate) struct Rims {
    pub(crate) stretches: [Vec<Stretch>; 2],
    /// Relative to the touched point, mm.
    pub(crate) lines_mm: [Vec<f64>; 2],
}

/// The underside of an indenter about the touched point.
struct Underside<'a> {
    indenter: &'a dyn SignedDistance,
    touch: &'a Pose,
    touched: DVec3,
    reach_mm: f64,
    ceiling_mm: f64,
    step_mm: f64,
}

impl Underside<'_> {
    /// Direction in which the distance from the indenter grows. Heights count from its origin.
    fn normal(&self, at_mm: DVec3) -> DVec3 {
        let flat = Pose {
            position_mm: self.touch.position_mm.with_z(0.0),
            ..*self.touch
        };
        let inside = flat.inverse_transform_point(at_mm);
        flat.rotation * self.indenter.signed_distance(inside).gradient
    }

    /// Radii of curvature along x and along y at a location relative to the touched point, mm. They
    /// are large where the underside is flat or hollow. `None` without an underside.
    fn radii_mm(&self, offset_mm: DVec2) -> Option<[f64; 2]> {
        let place = self.touched.truncate() + offset_mm;
        let lowest_mm = underside_mm(self.indenter, self.touch, place, self.reach_mm, self.ceiling_mm)?;
        let at_mm = place.extend(lowest_mm);
        Some([0, 1].map(|axis| {
            let aside_mm = STEP_MM * DVec3::AXES[axis];
            let turn = self.normal(at_mm + aside_mm)[axis] - self.normal(at_mm - aside_mm)[axis];
            2.0 * STEP_MM / turn.max(1e-9)
        }))
    }

    /// Smallest radius of curvature along an axis on the line across it at this offset, mm. `None`
    /// without an underside anywhere on it.
    fn smallest_mm(&self, axis: usize, offset_mm: f64) -> Option<f64> {
        (-SAMPLES..=SAMPLES)
            .filter_map(|index| {
                let mut at_mm = DVec2::splat(f64::from(index) * self.step_mm);
                at_mm[axis] = offset_mm;
                Some(self.radii_mm(at_mm)?[axis])
            })
            .reduce(f64::min)
    }

    /// Where flats end along an axis, given the smallest radii at the samples.
    fn flat_ends(&self, axis: usize, smallest_mm: &[Option<f64>]) -> Vec<FlatEnd> {
        let is_flat = |radius_mm: Option<f64>| radius_mm.is_some_and(|radius_mm| radius_mm >= FLAT_MM);
        let end = |index: usize, towards: f64| {
            let mut flat_mm = (index as f64 - f64::from(SAMPLES)) * self.step_mm;
            let mut beyond_mm = flat_mm + towards * self.step_mm;
            for _ in 0..HALVINGS {
                let middle_mm = 0.5 * (flat_mm + beyond_mm);
                if is_flat(self.smallest_mm(axis, middle_mm)) {
                    flat_mm = middle_mm;
                } else {
                    beyond_mm = middle_mm;
                }
            }
            // Where nothing is beyond, a tilted flat only goes on above the surface.
            let beside_mm = self.smallest_mm(axis, beyond_mm)?;
            // The curvature is measured this far beyond the location.
            let offset_mm = flat_mm + towards * STEP_MM;
            let beyond_mm = self.smallest_mm(axis, offset_mm + towards * STEP_MM);
            Some(FlatEnd {
                offset_mm,
                radius_mm: beyond_mm.unwrap_or(beside_mm).min(beside_mm),
            })
        };
        // Two samples in a row, because between the facets of a body with many of them, a single
        // sample is flat by chance.
        let windows = smallest_mm.windows(3).enumerate();
        windows
            .filter_map(|(index, window)| match [0, 1, 2].map(|at| is_flat(window[at])) {
                [true, true, false] => end(index + 1, 1.0),
                [false, true, true] => end(index + 1, -1.0),
                _ => None,
            })
            .collect()
    }
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
        let underside = Underside {
            indenter,
            touch,
            touched,
            reach_mm: low.abs().max(high.abs()).length(),
            ceiling_mm: touched.z - touch.position_mm.z + depth_mm,
            step_mm: within_mm / f64::from(SAMPLES),
        };
        let mut smallest_mm = [(); 2].map(|()| vec![None; 2 * SAMPLES as usize + 1]);
        for i in -SAMPLES..=SAMPLES {
            for j in -SAMPLES..=SAMPLES {
                let offset_mm = underside.step_mm * DVec2::new(f64::from(i), f64::from(j));
                let Some(radii_mm) = underside.radii_mm(offset_mm) else {
                    continue;
                };
                for (axis, index) in [i, j].into_iter().enumerate() {
                    let smallest_mm: &mut Option<f64> = &mut smallest_mm[axis][(index + SAMPLES) as usize];
                    *smallest_mm = Some(smallest_mm.unwrap_or(f64::INFINITY).min(radii_mm[axis]));
                }
            }
        }
        Self {
            step_mm: underside.step_mm,
            flat_ends: [0, 1].map(|axis| underside.flat_ends(axis, &smallest_mm[axis])),
            radius_mm: smallest_mm.map(|radii_mm| {
                let radii_mm = radii_mm.into_iter();
                radii_mm
                    .map(|radius_mm| radius_mm.unwrap_or(f64::INFINITY))
                    .collect()
            }),
        }
    }

    /// Stretches where `edges_per_radius` edges over the radius of curvature are shorter than
    /// `edge_mm`, and lines where flats end beside a rounding that is at least as wide as an edge:
    /// a narrower one is not resolved. No edge gets shorter than `shortest_mm`.
    pub(crate) fn rims(&self, edges_per_radius: f64, [shortest_mm, edge_mm]: [f64; 2]) -> Rims {
        let edge_at_mm = |radius_mm: f64| (radius_mm / edges_per_radius).max(shortest_mm);
        let stretches = [0, 1].map(|axis| {
            (-SAMPLES..)
                .zip(&self.radius_mm[axis])
                .map(|(index, &radius_mm)| Stretch {
                    offset_mm: f64::from(index) * self.step_mm,
                    reach_mm: 0.5 * self.step_mm,
                    edge_mm: edge_at_mm(radius_mm),
                })
                .filter(|stretch| stretch.edge_mm < edge_mm)
                .collect()
        });
        let lines_mm = [0, 1].map(|axis| {
            let ends = self.flat_ends[axis].iter();
            ends.filter(|end| edge_at_mm(end.radius_mm) <= edge_mm.min(end.radius_mm))
                .map(|end| end.offset_mm)
                .collect()
        });
        Rims { stretches, lines_mm }
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use twintac_shape::{Shape, Surfaces};

    use super::*;

    fn roundings(shape: &Shape, rotation: DQuat) -> Roundings {
        let indenter = shape.signed_distance_field(&Surfaces::default()).unwrap();
        let touched = DVec3::Z * 8.0;
        let touch = Pose {
            position_mm: touched,
            rotation,
        };
        Roundings::of(indenter.as_ref(), &touch, touched, 5.5, 2.0)
    }

    fn level(shape: &Shape) -> Roundings {
        roundings(shape, DQuat::IDENTITY)
    }

    fn bar() -> Shape {
        Shape::Box {
            size_mm: [3.0, 10.0, 10.0],
            edge_radius_mm: 0.5,
        }
    }

    #[test]
    fn a_ball_has_no_rim() {
        let ball = level(&Shape::Sphere { radius_mm: 12.5 });
        let rims = ball.rims(2.0, [0.1, 0.7]);
        assert!(rims.stretches.iter().all(Vec::is_empty) && rims.lines_mm.iter().all(Vec::is_empty));
    }

    #[test]
    fn edges_are_short_across_the_rim_of_a_bar() {
        let rims = level(&bar()).rims(2.0, [0.1, 0.7]);
        for (axis, half_width_mm) in rims.stretches.iter().zip([1.5, 5.0]) {
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

    /// Checks the ends of flats along one axis.
    #[track_caller]
    fn assert_ends(found: &[FlatEnd], expected_mm: &[f64], radius_mm: f64) {
        assert_eq!(found.len(), expected_mm.len(), "{found:?}");
        for (end, expected_mm) in found.iter().zip(expected_mm) {
            assert!((end.offset_mm - expected_mm).abs() < 2e-3, "{end:?}");
            assert!((end.radius_mm / radius_mm - 1.0).abs() < 0.2, "{end:?}");
        }
    }

    #[test]
    fn flats_end_where_rims_begin() {
        let [x, y] = level(&bar()).flat_ends;
        assert_ends(&x, &[-1.0, 1.0], 0.5);
        assert_ends(&y, &[-4.5, 4.5], 0.5);
        let turned = roundings(&bar(), DQuat::from_rotation_z(0.5 * std::f64::consts::PI));
        assert_ends(&turned.flat_ends[0], &[-4.5, 4.5], 0.5);
        let sharp = Shape::Box {
            size_mm: [3.0, 10.0, 10.0],
            edge_radius_mm: 0.0,
        };
        assert_ends(&level(&sharp).flat_ends[0], &[-1.5, 1.5], 2.0 * STEP_MM);
    }

    #[test]
    fn a_rim_narrower_than_an_edge_has_no_line() {
        let bar = level(&bar());
        assert_eq!(bar.rims(2.0, [0.4, 0.9]).lines_mm.map(|axis| axis.len()), [2, 2]);
        assert_eq!(bar.rims(2.0, [0.6, 0.9]).lines_mm.map(|axis| axis.len()), [0, 0]);
    }

    #[test]
    fn round_and_turned_rims_are_on_no_line() {
        let punch = Shape::Cylinder {
            radius_mm: 5.0,
            height_mm: 10.0,
            edge_radius_mm: 0.8,
        };
        let ring = Shape::Ring {
            outer_radius_mm: 5.0,
            inner_radius_mm: 3.0,
            height_mm: 5.0,
            edge_radius_mm: 0.3,
        };
        for shape in [punch, ring] {
            assert!(level(&shape).flat_ends.iter().all(Vec::is_empty), "{shape:?}");
        }
        let turned = roundings(&bar(), DQuat::from_rotation_z(0.4));
        assert!(turned.flat_ends.iter().all(Vec::is_empty));
    }

    #[test]
    fn a_tilted_flat_rises_above_the_surface_without_an_end() {
        let cube = Shape::Box {
            size_mm: [12.0, 10.0, 10.0],
            edge_radius_mm: 0.5,
        };
        let tilt_rad: f64 = 0.1;
        let indenter = cube.signed_distance_field(&Surfaces::default()).unwrap();
        // The lower rim is 5.5 mm aside and touches first.
        let touched = DVec3::new(-5.5 * tilt_rad.cos(), 0.0, 8.0);
        let touch = Pose {
            position_mm: DVec3::new(0.0, 0.0, 8.5),
            rotation: DQuat::from_rotation_y(-tilt_rad),
        };
        let found = Roundings::of(indenter.as_ref(), &touch, touched, 5.5, 0.3);
        assert_eq!(found.flat_ends[0].len(), 1, "{:?}", found.flat_ends);
        let deeper = Roundings::of(indenter.as_ref(), &touch, touched, 12.0, 3.0);
        assert_eq!(deeper.flat_ends[0].len(), 2, "{:?}", deeper.flat_ends);
    }
}
