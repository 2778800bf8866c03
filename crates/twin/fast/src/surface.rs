//! Grids over the gel's surface, at whose points the distance to bodies is sampled.

use glam::DVec2;
use serde::{Deserialize, Serialize};
use twintac_sensor::Sensor;

/// Height of the base of the gel, which is bonded to the board, mm.
pub(crate) const BASE_MM: f32 = 0.0;

/// Spacing of the grid's points along x and along y, mm. It is larger over a gel higher than ten of
/// these: the base of such a gel does not respond to such small details.
const SPACING_MM: f64 = 2.0;

/// Smallest spacing of the points as a fraction of the gel's height.
const SPACING_OF_HEIGHT: f64 = 1.0 / 10.0;

/// A grid of points on the undeformed gel's surface, row by row along x.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SurfaceGrid {
    /// Position of the first point in the gel's plane, mm.
    pub(crate) first_mm: [f64; 2],
    /// Spacing of the points, mm.
    pub(crate) spacing_mm: f64,
    /// Numbers of points along x and along y.
    pub(crate) n: [usize; 2],
    /// Height of the surface at each point, mm; beside the gel, that of its highest point.
    pub(crate) height_mm: Vec<f64>,
}

impl SurfaceGrid {
    /// Grids over a sensor's gel such that each taxel has a grid with a point above it. The first
    /// grid is that of the first taxel.
    pub(crate) fn all(sensor: &Sensor) -> Vec<Self> {
        let mut grids: Vec<Self> = Vec::new();
        for taxel in &sensor.taxels {
            let at = taxel.position_mm.truncate();
            if !grids.iter().any(|grid| grid.has(at)) {
                grids.push(Self::above(sensor, at));
            }
        }
        grids
    }

    /// A grid with a point above a location.
    pub(crate) fn above(sensor: &Sensor, anchor: DVec2) -> Self {
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let spacing_mm = SPACING_MM.max(SPACING_OF_HEIGHT * (high.z - low.z));
        let axis = |axis: usize| {
            let before = ((anchor[axis] - low[axis]) / spacing_mm).floor();
            let after = ((high[axis] - anchor[axis]) / spacing_mm).floor();
            (anchor[axis] - before * spacing_mm, (before + after) as usize + 1)
        };
        let [(x_mm, n_x), (y_mm, n_y)] = [axis(0), axis(1)];
        let mut grid = Self {
            first_mm: [x_mm, y_mm],
            spacing_mm,
            n: [n_x, n_y],
            height_mm: Vec::new(),
        };
        let top_mm = |at: DVec2| sensor.gel.solid.top_height_mm(at.x, at.y, &sensor.surfaces);
        grid.height_mm = grid.places().map(|at| top_mm(at).unwrap_or(high.z)).collect();
        grid
    }

    /// Whether the grid and the heights of its points are their own mirror images about a location,
    /// across x and across y.
    pub(crate) fn is_symmetric(&self, center_mm: DVec2) -> [bool; 2] {
        let [n_x, n_y] = self.n;
        [0, 1].map(|axis| {
            let last_mm = self.first_mm[axis] + self.spacing_mm * (self.n[axis] - 1) as f64;
            let is_central = (0.5 * (self.first_mm[axis] + last_mm) - center_mm[axis]).abs() < 1e-6;
            let mirror = |i: usize, j: usize| {
                if axis == 0 {
                    [n_x - 1 - i, j]
                } else {
                    [i, n_y - 1 - j]
                }
            };
            is_central
                && (0..self.len()).all(|point| {
                    let [i, j] = mirror(point % n_x, point / n_x);
                    (self.height_mm[point] - self.height_mm[j * n_x + i]).abs() < 1e-6
                })
        })
    }

    /// The points' positions in the gel's plane, mm.
    pub(crate) fn places(&self) -> impl Iterator<Item = DVec2> + '_ {
        let [n_x, n_y] = self.n;
        (0..n_y).flat_map(move |j| (0..n_x).map(move |i| self.place(i, j)))
    }

    /// Positions of points such that a disc of this radius, at that position on the gel's base, is
    /// within the gel, mm.
    pub(crate) fn floor(&self, sensor: &Sensor, radius_mm: f64) -> Vec<DVec2> {
        let (low, _) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let is_gel = |at: DVec2| {
            sensor
                .gel
                .solid
                .contains(at.extend(low.z), 1e-6, &sensor.surfaces)
        };
        let around = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y].map(|way| radius_mm * way);
        let places = self.places();
        places
            .filter(|at| around.iter().all(|way| is_gel(*at + *way)))
            .collect()
    }

    fn place(&self, i: usize, j: usize) -> DVec2 {
        DVec2::from(self.first_mm) + self.spacing_mm * DVec2::new(i as f64, j as f64)
    }

    /// Whether a point of the grid, or of the grid continued outward, is above a location.
    pub(crate) fn has(&self, at: DVec2) -> bool {
        self.cell(at).1.length() < 1e-6
    }

    /// Number of the point at a column and a row, if there is one.
    pub(crate) fn point(&self, [i, j]: [i32; 2]) -> Option<usize> {
        let [n_x, n_y] = self.n;
        let is_there = (0..n_x as i32).contains(&i) && (0..n_y as i32).contains(&j);
        is_there.then(|| j as usize * n_x + i as usize)
    }

    /// Column and row of a location, and its offset from them as a fraction of the spacing.
    pub(crate) fn cell(&self, at: DVec2) -> ([i32; 2], DVec2) {
        // Locations on the grid stay on it in spite of rounding.
        let cells = (at - DVec2::from(self.first_mm)) / self.spacing_mm + 1e-9;
        let cell = cells.floor();
        ([cell.x as i32, cell.y as i32], cells - cell)
    }

    /// Height of the gel at a location, mm, interpolated linearly between points; beside the grid,
    /// that of its border.
    pub(crate) fn height_mm_at(&self, at: DVec2) -> f64 {
        let ([i, j], part) = self.cell(at);
        let height_mm = |i: i32, j: i32| {
            let clamped = [(i, self.n[0]), (j, self.n[1])].map(|(index, n)| index.clamp(0, n as i32 - 1));
            self.point(clamped).map_or(0.0, |point| self.height_mm[point])
        };
        let row = |j: i32| height_mm(i, j) + part.x * (height_mm(i + 1, j) - height_mm(i, j));
        row(j) + part.y * (row(j + 1) - row(j))
    }

    /// Number of points.
    pub(crate) fn len(&self) -> usize {
        self.height_mm.len()
    }
}
