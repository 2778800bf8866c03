//! The steps of training.

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

/// Part of the steps over which the learning rate rises.
const RISE: f64 = 0.02;

/// Errors this small count by their square, larger ones by their size.
const SMALL: f32 = 3e-3;

/// What an error counts where there is no pressure, over what it counts where the pressure is the press's largest and as much.
const QUIET: f32 = 0.2;

/// Lever arm by which torques count as forces, mm.
const ARM_MM: f32 = 8.0;

/// Picks that a thread goes through together: few enough that their matrices stay in its cache.
const N_TOGETHER: usize = 64;

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

/// What is trained on, and how.
pub(crate) struct Course<'a> {
    pub(crate) frames: &'a Frames,
    pub(crate) layout: &'a Layout,
    pub(crate) settings: &'a TrainSettings,
    /// Whether the gel is its own mirror image across x and across y.
    pub(crate) is_symmetric: [bool; 2],
    /// Whether taxels get a network of their own: which taxel each is in the mirror image across x and across y, if they have one.
    pub(crate) mirrored_taxels: Option<[Option<Vec<usize>>; 2]>,
    pub(crate) seed: u64,
}

/// Trains the networks side by side; none knows of the others.
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
    /// Random weights for so many points and inputs in all, hidden units and outputs.
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

    /// Takes steps on what is picked at random. `batch` makes inputs of some of it, and their loss: sums of errors, and slopes of outputs. Threads share the picks;
    /// their slopes are added up in the order of the picks. Returns the mean error.
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

/// Sum over rows of the mean error over the press's largest pressure, and the slope of the outputs. `pressure` has as many rows and columns as the output.
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

/// Sum over frames of the mean error over the press's largest force, and the slope of the outputs.
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
