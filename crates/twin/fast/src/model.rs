//! What a trained fast twin is made of.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use twintac_sensor::Sensor;
use twintac_shape::{ShapeError, Solid};

use crate::Lesson;
use crate::contact::{ContactGrid, N_CHANNELS};
use crate::lesson::lesson_places_mm;
use crate::network::{Patch, Perceptron, Surroundings, Turn};
use crate::surface::SurfaceGrid;
use crate::training::{Frames, TrainProgress, TrainSettings, train};

/// What an output of 1 means, kPa.
pub(crate) const PRESSURE_KPA: f32 = 50.0;

/// What outputs of 1 mean: force, N, and torque, N mm.
pub(crate) const WRENCH: [f32; 6] = [1.0, 1.0, 10.0, 30.0, 30.0, 10.0];

/// Length of edges about which the networks are told, mm.
const EDGE_MM: f32 = 0.6;

/// How what touches is laid out for the networks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Layout {
    pub(crate) grid: SurfaceGrid,
    pub(crate) patch: Patch,
    pub(crate) surroundings: Surroundings,
}

/// The two trained networks.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Networks {
    /// From a patch to the pressure at its place.
    pub(crate) pressure: Perceptron,
    /// From the whole grid to force and torque.
    pub(crate) wrench: Perceptron,
}

/// A fast twin of one sensor's gel: from what touches to the pressure at each port and the force.
#[derive(Clone, Debug, PartialEq)]
pub struct FastGel {
    pub(crate) sensor: String,
    pub(crate) layout: Layout,
    /// Where the ports are, mm. `[n_taxels]`
    pub(crate) ports_mm: Vec<DVec2>,
    /// About which torques count, mm.
    pub(crate) center_mm: DVec3,
    pub(crate) networks: Networks,
}

impl FastGel {
    /// Learns from presses of a sensor's gel.
    ///
    /// # Errors
    /// A lesson whose shape can't be.
    pub fn train(
        sensor: &Sensor,
        lessons: &[Lesson],
        settings: &TrainSettings,
        seed: u64,
        progress: &mut dyn FnMut(TrainProgress),
    ) -> Result<Self, ShapeError> {
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let layout = Layout {
            grid: SurfaceGrid::of(sensor),
            patch: Patch::round(),
            surroundings: Surroundings::of(sensor),
        };
        let center_mm = (0.5 * (low + high)).with_z(high.z);
        let places_mm = lesson_places_mm(sensor);
        let frames = Frames::of(lessons, &layout.grid, &places_mm, center_mm)?;
        let is_symmetric = matches!(sensor.gel.solid, Solid::Block { .. }) && layout.is_symmetric(center_mm);
        let networks = train(&frames, &layout, settings, is_symmetric, seed, progress);
        Ok(Self {
            sensor: sensor.name.clone(),
            ports_mm: sensor
                .taxels
                .iter()
                .map(|taxel| taxel.position_mm.truncate())
                .collect(),
            layout,
            center_mm,
            networks,
        })
    }
}

impl FastGel {
    /// Name of the sensor.
    #[must_use]
    pub fn sensor(&self) -> &str {
        &self.sensor
    }
}

impl Layout {
    /// Inputs of the network of forces.
    pub(crate) fn n_field_inputs(&self) -> usize {
        ContactGrid::new(&self.grid).n_inputs() + 1
    }

    /// Whether the grid is its own mirror image about a place.
    fn is_symmetric(&self, center_mm: DVec3) -> bool {
        (0..2).all(|axis| {
            let last_mm = self.grid.first_mm[axis] + self.grid.spacing_mm * (self.grid.n[axis] - 1) as f64;
            (0.5 * (self.grid.first_mm[axis] + last_mm) - center_mm[axis]).abs() < 1e-6
        })
    }

    /// Appends the inputs of the network of pressures for a place on the grid.
    pub(crate) fn put_patch(
        &self,
        field: &[f32],
        cell: [i32; 2],
        at: DVec2,
        edge_mm: f32,
        turn: Turn,
        inputs: &mut Vec<f32>,
    ) {
        for point in self.patch.points(&self.grid, cell, turn) {
            match point {
                Some(point) => inputs.extend(&field[point * N_CHANNELS..(point + 1) * N_CHANNELS]),
                None => inputs.extend([0.0; N_CHANNELS]),
            }
        }
        self.surroundings.describe(&self.grid, at, turn, inputs);
        inputs.push(edge_mm - EDGE_MM);
    }

    /// Appends the inputs of the network of forces, mirrored across x and across y.
    pub(crate) fn put_field(&self, field: &[f32], edge_mm: f32, mirrored: [bool; 2], inputs: &mut Vec<f32>) {
        let [n_x, n_y] = self.grid.n;
        for j in 0..n_y {
            let j = if mirrored[1] { n_y - 1 - j } else { j };
            for i in 0..n_x {
                let i = if mirrored[0] { n_x - 1 - i } else { i };
                let point = j * n_x + i;
                inputs.extend(&field[point * N_CHANNELS..(point + 1) * N_CHANNELS]);
            }
        }
        inputs.push(edge_mm - EDGE_MM);
    }
}
