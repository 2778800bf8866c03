//! Searches for surfaces inside of other surfaces, or inside of themselves.

use glam::DVec3;

use crate::bvh::Bvh;
use crate::winding::Winding;

/// Distance between sample points, as a fraction of the surface's diagonal.
const SPACING: f64 = 0.04;
/// Distance from the surface at which a point is tested for being inside, as a fraction of the
/// surface's diagonal: twice the possible error of corners.
const ASIDE: f64 = 2e-5;
/// Largest number of sample points along a triangle's edge, and in total.
const MOST: (f64, usize) = (64.0, 50_000);

/// Sample points on some triangles of a surface, each with the area that it stands for and the
/// outward normal.
pub(crate) struct Places {
    places: Vec<Place>,
    aside_mm: f64,
}

struct Place {
    at_mm: DVec3,
    normal: DVec3,
    share: f64,
}

impl Places {
    pub(crate) fn on(bvh: &Bvh, corners: &dyn Fn(usize) -> [DVec3; 3]) -> Self {
        let (low, high) = bvh.bounds_mm();
        let spacing_mm = SPACING * low.distance(high);
        let rows = |[a, b, c]: [DVec3; 3]| {
            let longest_mm = a.distance(b).max(b.distance(c)).max(c.distance(a));
            (longest_mm / spacing_mm).ceil().clamp(1.0, MOST.0) as u32
        };
        let triangles = bvh.triangles().iter().map(|&triangle| corners(triangle));
        let n_places: usize = triangles
            .clone()
            .map(|corners| (rows(corners) * (rows(corners) + 1) / 2) as usize)
            .sum();
        let places = triangles.flat_map(|corners| {
            let [a, b, c] = corners;
            let n_rows = rows(corners);
            let area = (b - a).cross(c - a);
            let share = area.length() / f64::from(n_rows * (n_rows + 1) / 2);
            let normal = area.normalize_or_zero();
            let grid = (0..n_rows).flat_map(move |i| (0..n_rows - i).map(move |j| (i, j)));
            grid.map(move |(i, j)| {
                let part = |index: u32| (f64::from(index) + 1.0 / 3.0) / f64::from(n_rows);
                Place {
                    at_mm: a + part(i) * (b - a) + part(j) * (c - a),
                    normal,
                    share,
                }
            })
        });
        Self {
            places: places.step_by(n_places.div_ceil(MOST.1).max(1)).collect(),
            aside_mm: ASIDE * low.distance(high),
        }
    }

    /// The fraction of the area behind which the winding number of this closed surface is not that
    /// of its material, and a sample point there, mm. `None` if there is no such point.
    pub(crate) fn without_material(
        &self,
        bvh: &Bvh,
        corners: &dyn Fn(usize) -> [DVec3; 3],
        of_material: i32,
    ) -> Option<(f64, DVec3)> {
        let winding = Winding::new();
        let is_wrong = |place: &&Place| {
            let behind = place.at_mm - self.aside_mm * place.normal;
            winding.number(bvh, corners, behind) != of_material
        };
        let within: Vec<&Place> = self.places.iter().filter(is_wrong).collect();
        let sum = |places: &mut dyn Iterator<Item = f64>| places.sum::<f64>();
        let share = sum(&mut within.iter().map(|place| place.share))
            / sum(&mut self.places.iter().map(|place| place.share));
        Some((share, within.first()?.at_mm))
    }

    /// A sample point in front of which another body has its interior, mm; `None` if there is none.
    pub(crate) fn in_other(&self, other: &Bvh, corners: &dyn Fn(usize) -> [DVec3; 3]) -> Option<DVec3> {
        let winding = Winding::new();
        let in_front = |place: &Place| place.at_mm + self.aside_mm * place.normal;
        let is_inside = |place: &&Place| {
            let point = in_front(place);
            other.box_distance_mm(point) == 0.0 && winding.number(other, corners, point) > 0
        };
        self.places.iter().find(is_inside).map(|place| place.at_mm)
    }
}
