//! The steps of training.

use serde::{Deserialize, Serialize};
use twintac_learn::{AdamW, AdamWSettings, Matrix};
use twintac_random::digest_stream;

use super::Frames;
use super::batch::Batch;
use crate::contact::N_CHANNELS;
use crate::layout::Layout;
use crate::network::LocalNetwork;
use crate::networks::{Networks, PRESSURE_KPA, WRENCH};

/// Part of the steps over which the learning rate rises.
const RISE: f64 = 0.02;

/// Errors this small count by their square, larger ones by their size.
const SMALL: f32 = 3e-3;

/// What an error counts where there is no pressure, over what it counts where the pressure is the press's largest and as much.
const QUIET: f32 = 0.2;

/// Lever arm by which torques count as forces, mm.
const ARM_MM: f32 = 8.0;

/// How the networks are trained.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrainSettings {
    /// Steps of the optimizer.
    pub n_steps: usize,
    /// Frames of a step.
    pub n_frames: usize,
    /// Places of the floor of each frame.
    pub n_places: usize,
    /// The largest learning rate.
    pub learning_rate: f64,
    /// Decay of the weights.
    pub weight_decay: f64,
    /// Features of each point of the grid.
    pub n_features: usize,
    /// Hidden units for the pressure at a place.
    pub pressure_hidden: Vec<usize>,
    /// Hidden units for force and torque.
    pub wrench_hidden: Vec<usize>,
}

impl Default for TrainSettings {
    fn default() -> Self {
        Self {
            n_steps: 40_000,
            n_frames: 128,
            n_places: 8,
            learning_rate: 5e-3,
            weight_decay: 1e-3,
            n_features: 6,
            pressure_hidden: vec![64, 32, 32],
            wrench_hidden: vec![64, 32, 32],
        }
    }
}

/// How training goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrainProgress {
    /// Steps that are done.
    pub step: usize,
    /// How many there will be.
    pub of: usize,
    /// Mean error of the pressures since the last report, as part of each press's largest.
    pub pressure: f32,
    /// Mean error of forces and torques, as part of each press's largest force.
    pub wrench: f32,
}

/// Steps between reports.
pub const REPORT_STEPS: usize = 100;

/// Trains the networks.
pub(crate) fn train(
    frames: &Frames,
    layout: &Layout,
    settings: &TrainSettings,
    is_symmetric: bool,
    seed: u64,
    progress: &mut dyn FnMut(TrainProgress),
) -> Networks {
    let mut random = digest_stream(seed, "fast twin");
    let (n_patch, n_grid) = (layout.patch.offsets.len(), layout.grid.len());
    let n_others = |n_inputs: usize, n_points: usize| n_inputs - n_points * N_CHANNELS;
    let pressure = [
        n_patch,
        settings.n_features,
        n_others(layout.patch.n_inputs(), n_patch),
    ];
    let wrench = [
        n_grid,
        settings.n_features,
        n_others(layout.n_field_inputs(), n_grid),
    ];
    let mut networks = Networks {
        pressure: LocalNetwork::new(pressure, &settings.pressure_hidden, 1, &mut random),
        wrench: LocalNetwork::new(wrench, &settings.wrench_hidden, 6, &mut random),
    };
    let optimizer_settings = AdamWSettings {
        weight_decay: settings.weight_decay as f32,
        gradient_norm: 1.0,
    };
    let mut optimizers = [&networks.pressure, &networks.wrench]
        .map(|network| AdamW::new(network.arrays(), optimizer_settings));
    let mut sums = [0.0_f32; 2];
    for step in 0..settings.n_steps {
        let sizes = [settings.n_frames, settings.n_places];
        let batch = Batch::draw(frames, layout, sizes, is_symmetric, &mut random);
        let rate = settings.learning_rate * schedule(step as f64 / settings.n_steps as f64);
        let Batch {
            patches,
            pressure,
            largest_kpa,
            fields,
            wrench,
            largest_n,
        } = batch;

        let (output, kept) = networks.pressure.forward(&patches, n_patch);
        let (error, slope) = pressure_loss(&output, &pressure, &largest_kpa);
        sums[0] += error;
        let mut slopes = networks.pressure.zeros();
        networks.pressure.backward(&kept, slope, n_patch, &mut slopes);
        optimizers[0].step(rate, networks.pressure.arrays_mut(), slopes.arrays());

        let (output, kept) = networks.wrench.forward(&fields, n_grid);
        let (error, slope) = wrench_loss(&output, &wrench, &largest_n);
        sums[1] += error;
        let mut slopes = networks.wrench.zeros();
        networks.wrench.backward(&kept, slope, n_grid, &mut slopes);
        optimizers[1].step(rate, networks.wrench.arrays_mut(), slopes.arrays());

        if (step + 1) % REPORT_STEPS == 0 {
            let [pressure, wrench] = sums.map(|sum| sum / REPORT_STEPS as f32);
            sums = [0.0; 2];
            progress(TrainProgress {
                step: step + 1,
                of: settings.n_steps,
                pressure,
                wrench,
            });
        }
    }
    networks
}

/// Rises at first, then falls to zero along a cosine.
fn schedule(part: f64) -> f64 {
    let fall = 0.5 * (1.0 + (std::f64::consts::PI * part).cos());
    (part / RISE).min(1.0) * fall
}

/// A smooth size of an error, and its slope.
fn size(error: f32) -> (f32, f32) {
    let size = (error * error + SMALL * SMALL).sqrt();
    (size, error / size)
}

/// Mean error over the press's largest pressure, and the slope of the outputs.
fn pressure_loss(output: &Matrix, pressure: &[f32], largest_kpa: &[f32]) -> (f32, Matrix) {
    let mut slope = Matrix::zeros(output.n_rows(), 1);
    let mut sum = 0.0;
    let share = 1.0 / pressure.len() as f32;
    for (row, (pressure, largest_kpa)) in pressure.iter().zip(largest_kpa).enumerate() {
        let scale = PRESSURE_KPA / largest_kpa;
        let error = output.values[row] * scale - pressure;
        let (size, direction) = size(error);
        sum += size;
        slope.values[row] = share * direction * scale * (QUIET + pressure.max(0.0));
    }
    (sum * share, slope)
}

/// Mean error over the press's largest force, and the slope of the outputs.
fn wrench_loss(output: &Matrix, wrench: &[[f32; 6]], largest_n: &[f32]) -> (f32, Matrix) {
    let mut slope = Matrix::zeros(output.n_rows(), 6);
    let mut sum = 0.0;
    let share = 1.0 / output.values.len() as f32;
    for (row, (wrench, largest_n)) in wrench.iter().zip(largest_n).enumerate() {
        for component in 0..6 {
            let arm = if component < 3 { 1.0 } else { ARM_MM };
            let scale = WRENCH[component] / (largest_n * arm);
            let index = 6 * row + component;
            let error = output.values[index] * scale - wrench[component] / (largest_n * arm);
            let (size, direction) = size(error);
            sum += size;
            slope.values[index] = share * direction * scale;
        }
    }
    (sum * share, slope)
}
