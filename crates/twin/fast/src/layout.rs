//! How contact geometry is arranged as inputs of the networks.

use glam::DVec2;
use serde::{Deserialize, Serialize};
use twintac_sensor::Sensor;

use crate::contact::N_CHANNELS;
use crate::network::{Patch, Surroundings, Turn};
use crate::surface::SurfaceGrid;

/// Height of PhysTac's gel, mm.
const HEIGHT_MM: f64 = 8.5;

/// The shortest mesh edges under a shape on that gel, mm. A network input says by how much the
/// edges of a training press are longer; the trained networks are evaluated as if they were not.
const FINEST_MM: f64 = 0.6;

/// The shortest mesh edges as a fraction of a gel's width, in proportion to which shapes are drawn.
/// They limit the edges of a high gel: 0.75 mm for the fingertip's.
const FINEST_OF_WIDTH: f64 = 0.03;

/// Length of the shortest edges of the meshes of training presses, mm. `height_mm`: height of the
/// gel; `width_mm`: root of its area in plan.
#[must_use]
pub fn finest_edge_mm(height_mm: f64, width_mm: f64) -> f64 {
    (height_mm / HEIGHT_MM * FINEST_MM).min(FINEST_OF_WIDTH * width_mm)
}

/// How contact geometry is arranged as inputs of the networks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Layout {
    /// Each port is below a point of one of them. Force and torque are computed from the first,
    /// which may have no port.
    pub(crate) grids: Vec<SurfaceGrid>,
    pub(crate) patch: Patch,
    pub(crate) surroundings: Surroundings,
}

impl Layout {
    /// The layout for a sensor's gel.
    pub(crate) fn of(sensor: &Sensor) -> Self {
        let (mut grids, surroundings) = (SurfaceGrid::all(sensor), Surroundings::of(sensor));
        // Presses are also used mirrored to train the force, if the grid that it is computed from
        // has mirror symmetry.
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let center_mm = 0.5 * (low + high).truncate();
        let central = SurfaceGrid::above(sensor, center_mm);
        let n_axes = |grid: &SurfaceGrid| grid.is_symmetric(center_mm).into_iter().filter(|is| *is).count();
        if n_axes(&central) > n_axes(&grids[0]) {
            grids.insert(0, central);
        }
        Self {
            patch: Patch::round(&grids[0], surroundings.height_mm()),
            grids,
            surroundings,
        }
    }

    /// Number of inputs of the network of force and torque.
    pub(crate) fn n_field_inputs(&self) -> usize {
        self.grid().len() * N_CHANNELS + 1
    }

    /// Number of points of all grids.
    pub(crate) fn n_points(&self) -> usize {
        self.first_point(self.grids.len())
    }

    /// Number of points of the grids before one.
    pub(crate) fn first_point(&self, grid: usize) -> usize {
        self.grids[..grid].iter().map(SurfaceGrid::len).sum()
    }

    /// Number of a grid with a point above a location.
    pub(crate) fn grid_at(&self, at: DVec2) -> Option<usize> {
        self.grids.iter().position(|grid| grid.has(at))
    }

    /// The first grid.
    pub(crate) fn grid(&self) -> &SurfaceGrid {
        &self.grids[0]
    }

    fn finest_edge_mm(&self) -> f64 {
        finest_edge_mm(self.surroundings.height_mm(), self.surroundings.width_mm())
    }

    /// By how much edges are longer than the shortest, mm, scaled to a gel as high as PhysTac's.
    fn coarseness(&self, edge_mm: f32) -> f32 {
        let finest_mm = self.finest_edge_mm();
        (FINEST_MM * (f64::from(edge_mm) / finest_mm - 1.0)) as f32
    }

    /// Appends the inputs of the network of pressures for a location on a grid.
    pub(crate) fn put_patch(
        &self,
        field: &[f32],
        (number, cell): (usize, [i32; 2]),
        at: DVec2,
        edge_mm: f32,
        turn: Turn,
        inputs: &mut Vec<f32>,
    ) {
        let grid = &self.grids[number];
        let field = &field[N_CHANNELS * self.first_point(number)..];
        for point in self.patch.points(grid, cell, turn) {
            match point {
                Some(point) => inputs.extend(&field[point * N_CHANNELS..(point + 1) * N_CHANNELS]),
                None => inputs.extend([0.0; N_CHANNELS]),
            }
        }
        self.surroundings.describe(grid, at, turn, inputs);
        inputs.push(self.coarseness(edge_mm));
    }

    /// Appends the inputs of the network of force and torque, mirrored across x and across y where
    /// asked for.
    pub(crate) fn put_field(&self, field: &[f32], edge_mm: f32, mirrored: [bool; 2], inputs: &mut Vec<f32>) {
        let [n_x, n_y] = self.grid().n;
        for j in 0..n_y {
            let j = if mirrored[1] { n_y - 1 - j } else { j };
            for i in 0..n_x {
                let i = if mirrored[0] { n_x - 1 - i } else { i };
                let point = j * n_x + i;
                inputs.extend(&field[point * N_CHANNELS..(point + 1) * N_CHANNELS]);
            }
        }
        inputs.push(self.coarseness(edge_mm));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use twintac_sensor::SensorFile;

    #[test]
    fn the_finest_meshes_are_what_readings_assume_on_gels_of_any_height() {
        for file in [SensorFile::phystac().unwrap(), SensorFile::phystac_tip().unwrap()] {
            let layout = Layout::of(&file.sensor);
            let finest_mm = layout.finest_edge_mm() as f32;
            assert!(layout.coarseness(finest_mm).abs() < 1e-6, "{}", file.sensor.name);
            assert!((layout.coarseness(1.5 * finest_mm) - 0.3).abs() < 1e-6);
        }
    }

    #[test]
    fn forces_are_read_from_a_grid_with_the_gels_mirror_images() {
        // Ports 5 mm apart are on four grids of points 2 mm apart. None of these grids is its own
        // mirror image.
        let mut sensor = (*SensorFile::phystac().unwrap().sensor).clone();
        let n_before = Layout::of(&sensor).grids.len();
        assert_eq!(
            (n_before, Layout::of(&sensor).grids),
            (1, SurfaceGrid::all(&sensor))
        );
        for (number, taxel) in sensor.taxels.iter_mut().enumerate() {
            let (column, row) = (number as f64 % 4.0, (number / 4) as f64);
            taxel.position_mm = glam::DVec3::new(5.0 * column - 7.5, 5.0 * row - 2.5, 0.0);
        }
        let layout = Layout::of(&sensor);
        assert_eq!(layout.grids.len(), 5);
        assert_eq!(layout.grid().is_symmetric(DVec2::ZERO), [true; 2]);
        assert_eq!(layout.grids[1..], SurfaceGrid::all(&sensor));
    }
}
