//! The training loop.

use std::ops::Range;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use twintac_learn::{AdamW, AdamWSettings, Matrix};
use twintac_random::{RandomStream, digest_stream};

use super::Frames;
use super::batch::{GridPick, PressureBatch, TaxelBatch, WrenchBatch};
use crate::contact::N_CHANNELS;
use crate::layout::Layout;
use crate::network::LocalNetwork;
use crate::networks::{Networks, PRESSURE_KPA, WRENCH};

/// Fraction of the steps over which the learning rate rises.
const RISE: f64 = 0.02;

/// Errors below this size count quadratically, larger ones linearly.
const SMALL: f32 = 3e-3;

/// Weight of an error where the pressure is zero. The weight grows by the pressure as a fraction of
/// the press's largest.
const QUIET: f32 = 0.2;

/// Lever arm by which torques are divided to count as forces, mm.
const ARM_MM: f32 = 8.0;

/// Samples that a thread processes together: few enough that their matrices stay in its cache.
const N_TOGETHER: usize = 64;

/// Settings of the training.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrainSettings {
    /// Number of steps of the optimizer.
    pub n_steps: usize,
    /// Frames in each step.
    pub n_frames: usize,
    /// Locations of the base for each frame.
    pub n_places: usize,
    /// The largest learning rate.
    pub learning_rate: f64,
    /// Weight decay.
    pub weight_decay: f64,
    /// Features of each point of the grid.
    pub n_features: usize,
    /// Hidden units of each layer of the network of pressures.
    pub pressure_hidden: Vec<usize>,
    /// Hidden units of each layer of the network of force and torque.
    pub wrench_hidden: Vec<usize>,
}

impl Default for TrainSettings {
    fn default() -> Self {
        Self {
            n_steps: 80_000,
            n_frames: 128,
            n_places: 8,
            learning_rate: 5e-3,
            weight_decay: 1e-3,
            n_features: 6,
            pressure_hidden: vec![64, 32, 32],
            wrench_hidden: vec![32, 32, 32],
        }
    }
}

/// Progress of the training.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrainProgress {
    /// Steps that are done.
    pub step: usize,
    /// Number of all steps.
    pub of: usize,
    /// Mean error of the pressures since the last report, as a fraction of each press's largest
    /// pressure.
    pub pressure: f32,
    /// Mean error of forces and torques since the last report, as a fraction of each press's
    /// largest force.
    pub wrench: f32,
}

/// Number of steps between reports.
pub const REPORT_STEPS: usize = 100;

/// Training data and settings.
pub(crate) struct Course<'a> {
    pub(crate) frames: &'a Frames,
    pub(crate) layout: &'a Layout,
    pub(crate) settings: &'a TrainSettings,
    /// Whether the gel is its own mirror image across x and across y.
    pub(crate) is_symmetric: [bool; 2],
    /// Whether the taxels get a network of their own: then, for each axis, the number of each
    /// taxel's mirror image, if all taxels have one.
    pub(crate) mirrored_taxels: Option<[Option<Vec<usize>>; 2]>,
    pub(crate) seed: u64,
}

/// Trains the networks in parallel and independently of each other.
pub(crate) fn train(course: &Course<'_>, progress: &mut dyn FnMut(TrainProgress)) -> Networks {
    let Course {
        frames,
        layout,
        settings,
        is_symmetric,
        mirrored_taxels,
        ..
    } = course;
    let n_field = [layout.grid().len(), layout.n_field_inputs()];
    let n_patch = [layout.patch.offsets.len(), layout.patch.n_inputs()];
    let mut pressure = Training::new("pressure", course, n_patch, &settings.pressure_hidden, 1);
    let mut wrench = Training::new("wrench", course, n_field, &settings.wrench_hidden, 6);
    let mut taxels = mirrored_taxels.as_ref().map(|mirrored| {
        let training = Training::new(
            "taxels",
            course,
            n_field,
            &settings.pressure_hidden,
            frames.n_taxels,
        );
        (mirrored, training)
    });
    let sizes = [settings.n_frames, settings.n_places];
    let mut step = 0;
    while step < settings.n_steps {
        let next = (step + REPORT_STEPS).min(settings.n_steps);
        let mut pressure_steps = || {
            pressure.steps(
                step..next,
                settings,
                |random| PressureBatch::picks(frames, sizes, random),
                |picks| {
                    let batch = PressureBatch::of(frames, layout, picks);
                    (batch.inputs, move |output: &Matrix| {
                        pressure_loss(output, &batch.pressure, &batch.largest_kpa)
                    })
                },
            )
        };
        let mut wrench_steps = || {
            wrench.steps(
                step..next,
                settings,
                |random| GridPick::picks(frames, settings.n_frames, *is_symmetric, random),
                |picks| {
                    let batch = WrenchBatch::of(frames, layout, picks);
                    (batch.inputs, move |output: &Matrix| {
                        wrench_loss(output, &batch.wrench, &batch.largest_n)
                    })
                },
            )
        };
        let mut taxel_steps = || {
            let (mirrored, training) = taxels.as_mut()?;
            let is_symmetric = [0, 1].map(|axis| mirrored[axis].is_some());
            Some(training.steps(
                step..next,
                settings,
                |random| GridPick::picks(frames, settings.n_frames, is_symmetric, random),
                |picks| {
                    let batch = TaxelBatch::of(frames, layout, mirrored, picks);
                    (batch.inputs, move |output: &Matrix| {
                        pressure_loss(output, &batch.pressure, &batch.largest_kpa)
                    })
                },
            ))
        };
        let (pressure_error, (wrench_error, taxel_error)) = rayon::join(&mut pressure_steps, || {
            rayon::join(&mut wrench_steps, &mut taxel_steps)
        });
        step = next;
        progress(TrainProgress {
            step,
            of: settings.n_steps,
            pressure: taxel_error.unwrap_or(pressure_error),
            wrench: wrench_error,
        });
    }
    Networks {
        pressure: pressure.network,
        wrench: wrench.network,
        taxels: taxels.map(|(_, training)| training.network),
    }
}

/// A network in training.
struct Training {
    network: LocalNetwork,
    optimizer: AdamW,
    random: RandomStream,
    n_points: usize,
}

impl Training {
    /// Random weights for these numbers of points, inputs, hidden units and outputs.
    fn new(
        name: &str,
        course: &Course<'_>,
        [n_points, n_inputs]: [usize; 2],
        hidden: &[usize],
        n_outputs: usize,
    ) -> Self {
        let mut random = digest_stream(course.seed, &format!("fast twin, {name}"));
        let n_others = n_inputs - n_points * N_CHANNELS;
        let inputs = [n_points, course.settings.n_features, n_others];
        let network = LocalNetwork::new(inputs, hidden, n_outputs, &mut random);
        let settings = AdamWSettings {
            weight_decay: course.settings.weight_decay as f32,
            gradient_norm: 1.0,
        };
        Self {
            optimizer: AdamW::new(network.arrays(), settings),
            network,
            random,
            n_points,
        }
    }

    /// Takes steps on random samples. `batch` makes inputs of some samples, and their loss: the sum
    /// of errors, and the gradient of the outputs. The samples are distributed over threads; the
    /// gradients are added in the order of the samples. Returns the mean error.
    fn steps<P: Sync, L: FnOnce(&Matrix) -> (f32, Matrix)>(
        &mut self,
        steps: Range<usize>,
        settings: &TrainSettings,
        picks: impl Fn(&mut RandomStream) -> Vec<P>,
        batch: impl Fn(&[P]) -> (Matrix, L) + Sync,
    ) -> f32 {
        let mut sum = 0.0;
        let n_steps = steps.len();
        for step in steps {
            let picks = picks(&mut self.random);
            let (network, n_points) = (&self.network, self.n_points);
            let parts = picks.par_chunks(N_TOGETHER).map(|picks| {
                let (inputs, loss) = batch(picks);
                let (output, kept) = network.forward(&inputs, n_points);
                let (error, slope) = loss(&output);
                let mut slopes = network.zeros();
                network.backward(&kept, slope, n_points, &mut slopes);
                (error, slopes)
            });
            let share = 1.0 / picks.len() as f32;
            let mut slopes = network.zeros();
            for (error, part) in parts.collect::<Vec<_>>() {
                sum += share * error;
                for (slopes, part) in slopes.arrays_mut().zip(part.arrays()) {
                    slopes
                        .iter_mut()
                        .zip(part)
                        .for_each(|(slope, part)| *slope += share * part);
                }
            }
            let rate = settings.learning_rate * schedule(step as f64 / settings.n_steps as f64);
            self.optimizer
                .step(rate, self.network.arrays_mut(), slopes.arrays());
        }
        sum / n_steps as f32
    }
}

/// Learning rate as a fraction of the largest: it rises first, then falls to zero along a cosine.
fn schedule(part: f64) -> f64 {
    let fall = 0.5 * (1.0 + (std::f64::consts::PI * part).cos());
    (part / RISE).min(1.0) * fall
}

/// A smooth absolute value of an error, and its derivative.
fn size(error: f32) -> (f32, f32) {
    let size = (error * error + SMALL * SMALL).sqrt();
    (size, error / size)
}

/// Sum over rows of the mean error over the press's largest pressure, and the gradient of the
/// outputs. `pressure` has as many rows and columns as the output.
fn pressure_loss(output: &Matrix, pressure: &[f32], largest_kpa: &[f32]) -> (f32, Matrix) {
    let n_columns = output.n_columns;
    let mut slope = Matrix::zeros(output.n_rows(), n_columns);
    let mut sum = 0.0;
    let share = 1.0 / n_columns as f32;
    for (index, pressure) in pressure.iter().enumerate() {
        let scale = PRESSURE_KPA / largest_kpa[index / n_columns];
        let error = output.values[index] * scale - pressure;
        let (size, direction) = size(error);
        sum += size;
        slope.values[index] = share * direction * scale * (QUIET + pressure.max(0.0));
    }
    (sum * share, slope)
}

/// Sum over frames of the mean error over the press's largest force, and the gradient of the
/// outputs.
fn wrench_loss(output: &Matrix, wrench: &[[f32; 6]], largest_n: &[f32]) -> (f32, Matrix) {
    let mut slope = Matrix::zeros(output.n_rows(), 6);
    let mut sum = 0.0;
    let share = 1.0 / output.n_columns as f32;
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
