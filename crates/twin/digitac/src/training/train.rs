//! Trains the variants, and selects one by their errors on validation presses.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};
use twintac_config::Checked;
use twintac_learn::{AdamW, AdamWSettings};

use super::batch::{Batch, batches};
use super::{Split, TrainSettings};
use crate::bench_fit::in_order;
use crate::evaluation::{Scale, Score, score_some};
use crate::network::{Normalization, Parameters, Physics};
use crate::physical_fit::{BarometerModel, Fitted, Known, Series, fit};
use crate::{DigitacError, Features, Gains, PairedPress, Twin, Variant, seed};

/// Smallest learning rate.
const SMALLEST_RATE: f64 = 1e-6;

/// The progress of a training.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The variant in training.
    pub variant: Variant,
    /// Epochs done.
    pub epoch: usize,
    /// Largest number of epochs.
    pub of: usize,
    /// Loss on training presses: mean absolute deviation over the largest reading.
    pub loss: f64,
    /// Loss on validation presses.
    pub validation_loss: f64,
}

/// Losses along a training.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Epoch {
    /// Learning rate.
    pub learning_rate: f64,
    /// Loss on training presses, with noise.
    pub loss: f64,
    /// Loss on validation presses.
    pub validation_loss: f64,
}

/// A trained variant.
#[derive(Clone, Debug)]
pub struct Trained {
    /// The twin with the weights of its best epoch.
    pub twin: Twin,
    /// Its errors on the validation presses.
    pub validation: Score,
    /// The losses along its training.
    pub history: Vec<Epoch>,
}

/// Trains every variant of the settings, in their order, unless `progress` stops it. `presses` are
/// all presses of the recording, because relaxation after presses that are not used for training is
/// taken into account. `seed` draws weights, batches and noise.
///
/// # Errors
/// Settings outside their ranges; presses without a usable reading above zero; a loss that is not
/// finite; [`DigitacError::Stopped`].
pub fn train(
    presses: &[PairedPress],
    taxels: &[String],
    split: &Split,
    scale: &Scale,
    settings: &TrainSettings,
    seed: u64,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Vec<Trained>, DigitacError> {
    settings.checked()?;
    let parts = Parts::new(presses, taxels, split)?;
    let no_scale = || DigitacError::TooFew {
        expected: "usable readings above zero to train with".into(),
        found: "none".into(),
    };
    let normalization = Normalization::of(&parts.of(&split.train)).ok_or_else(no_scale)?;
    let both = [&split.train[..], &split.validation].concat();
    settings
        .variants()
        .iter()
        .map(|&variant| {
            let physics = |training_presses: &[usize]| -> Result<Physics, DigitacError> {
                Ok(Physics {
                    variant,
                    gains: parts.gains(variant, training_presses, &scale.left_out, settings)?,
                    normalization: normalization.clone(),
                    correction_limit: settings.correction_limit,
                })
            };
            let of_train = physics(&split.train)?;
            let mut history = Vec::new();
            let parameters = if variant.has_perceptron() {
                let (parameters, losses) =
                    train_variant(&of_train, &parts, split, (settings, seed), progress)?;
                history = losses;
                parameters
            } else {
                Parameters::new(&of_train, &[], seed)
            };
            let mut twin = Twin::new(taxels.to_vec(), of_train, parameters);
            let validation = score_some(&twin, presses, &split.validation, scale);
            if !variant.has_perceptron() {
                // Validation presses did not stop the training of these variants. Once they have
                // been used for the choice, they may be used for training as well.
                let of_both = physics(&both)?;
                let parameters = Parameters::new(&of_both, &[], seed);
                twin = Twin::new(taxels.to_vec(), of_both, parameters);
            }
            Ok(Trained {
                twin,
                validation,
                history,
            })
        })
        .collect()
}

/// The variant with the smallest headline error on validation presses; test presses are not used.
/// Of equal variants, the first.
///
/// # Errors
/// Nothing was trained, or no validation press is in contact, so that no variant can be selected.
pub fn choose(trained: &[Trained]) -> Result<&Trained, DigitacError> {
    if trained.is_empty() {
        return Err(DigitacError::TooFew {
            expected: "a variant to choose".into(),
            found: "none".into(),
        });
    }
    let error = |t: &Trained| t.validation.overall.nearest_in_contact.percent;
    let evaluated = trained
        .iter()
        .filter_map(|trained| Some((trained, error(trained)?)));
    let best = evaluated.min_by(|a, b| a.1.total_cmp(&b.1));
    best.map(|(trained, _)| trained)
        .ok_or_else(|| DigitacError::TooFew {
            expected: "validation presses in contact, to choose a variant by".into(),
            found: "none".into(),
        })
}

struct Parts<'a> {
    presses: &'a [PairedPress],
    n_taxels: usize,
}

impl<'a> Parts<'a> {
    fn new(presses: &'a [PairedPress], taxels: &[String], split: &Split) -> Result<Self, DigitacError> {
        for index in split.train.iter().chain(&split.validation) {
            let press = presses.get(*index).ok_or_else(|| DigitacError::TooFew {
                expected: format!("press {index} of the split"),
                found: format!("{} presses", presses.len()),
            })?;
            let f = &press.features;
            let widths = [&press.readings_kpa, &f.pressure_kpa, &f.stress_kpa_per_mm];
            if widths
                .iter()
                .any(|rows| rows.len() != f.n_frames() || rows.iter().any(|r| r.len() != taxels.len()))
            {
                let problem = format!("does not have {} rows of {} taxels", f.n_frames(), taxels.len());
                return Err(DigitacError::press(&press.name, problem));
            }
        }
        if split.train.is_empty() || split.validation.is_empty() {
            return Err(DigitacError::TooFew {
                expected: "presses to train and to validate with".into(),
                found: format!("{} and {}", split.train.len(), split.validation.len()),
            });
        }
        Ok(Self {
            presses,
            n_taxels: taxels.len(),
        })
    }

    fn of(&self, indices: &[usize]) -> Vec<&'a PairedPress> {
        indices.iter().map(|&index| &self.presses[index]).collect()
    }

    /// Gains of the barometers that fit some presses best.
    fn gains(
        &self,
        variant: Variant,
        training_presses: &[usize],
        left_out: &BTreeSet<usize>,
        settings: &TrainSettings,
    ) -> Result<Gains, DigitacError> {
        let constants: &[f64] = if variant.has_memory() {
            &settings.time_constants_s
        } else {
            &[]
        };
        let every_press = self.presses.iter().map(|press| &press.features);
        let model = BarometerModel::new(every_press, constants, settings.port_law);
        let training_presses: BTreeSet<usize> = training_presses.iter().copied().collect();
        let presses = in_order(self.presses.iter().map(|press| &press.mounting[..]));
        let fitted: Vec<Fitted<'_>> = presses
            .iter()
            .map(|&index| {
                let press = &self.presses[index];
                Fitted {
                    mounting: &press.mounting,
                    features: &press.features,
                    readings_kpa: &press.readings_kpa,
                    valid: &press.valid,
                    is_used: training_presses.contains(&index),
                }
            })
            .collect();
        let pressure = |k: usize| {
            let rows = fitted.iter().flat_map(|press| &press.features.pressure_kpa);
            rows.map(|row| row[k]).collect()
        };
        let known = Known {
            kpa: (0..self.n_taxels).map(pressure).collect(),
        };
        let series = Series::new(&fitted, self.n_taxels, left_out);
        Ok(fit(&known, &series, &model, left_out, None)?.gains)
    }

    /// Presses as used for training a network: as if the gel had rested before each. The remaining
    /// relaxation after earlier presses, according to the physics alone, is subtracted from their
    /// readings.
    fn rested(&self, physics: &Physics, indices: &[usize]) -> Vec<PairedPress> {
        let all: Vec<&Features> = self.presses.iter().map(|press| &press.features).collect();
        let remembered = physics.gains.readings_kpa(&all);
        let rested = |&index: &usize| {
            let mut press = self.presses[index].clone();
            press.features.since_previous_s = None;
            let alone = physics.gains.readings_kpa(&[&press.features]).swap_remove(0);
            for ((row, with), without) in press.readings_kpa.iter_mut().zip(&remembered[index]).zip(&alone) {
                for ((reading, with), without) in row.iter_mut().zip(with).zip(without) {
                    *reading -= with - without;
                }
            }
            press
        };
        indices.iter().map(rested).collect()
    }
}

/// The parameters with the smallest loss on validation presses, and the losses of each epoch.
fn train_variant(
    physics: &Physics,
    parts: &Parts<'_>,
    split: &Split,
    (settings, seed_number): (&TrainSettings, u64),
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<(Parameters, Vec<Epoch>), DigitacError> {
    let variant = physics.variant;
    let gather = |presses: &[usize]| gather(physics, &parts.rested(physics, presses), settings, seed_number);
    let (train, validation) = (gather(&split.train), gather(&split.validation));
    let mut random = seed::stream(seed_number, &format!("training/{variant}"));
    let mut parameters = Parameters::new(physics, settings.hidden(variant), seed_number);
    let mut optimizer = AdamW::new(
        parameters.arrays(),
        AdamWSettings {
            weight_decay: settings.weight_decay as f32,
            gradient_norm: settings.gradient_norm as f32,
        },
    );
    let mut learning_rate = settings.learning_rate;
    let mut best_loss = mean_loss(&parameters, physics, &validation);
    let (mut best, mut since_best) = (parameters.clone(), 0);
    let mut history = Vec::new();
    let mut order: Vec<usize> = (0..train.len()).collect();
    for epoch in 0..settings.epochs {
        order.shuffle(&mut random);
        let mut sum = 0.0;
        for &index in &order {
            let noise = (settings.noise(variant), &mut random);
            let (loss, gradient) = train[index].loss_and_gradient(&parameters, physics, noise);
            sum += f64::from(loss);
            optimizer.step(learning_rate, parameters.arrays_mut(), gradient.arrays());
        }
        let loss = sum / train.len() as f64;
        let validation_loss = mean_loss(&parameters, physics, &validation);
        if !(loss.is_finite() && validation_loss.is_finite()) {
            return Err(DigitacError::Diverged {
                variant: variant.to_string(),
                epoch,
                loss,
            });
        }
        history.push(Epoch {
            learning_rate,
            loss,
            validation_loss,
        });
        let follows = progress(Progress {
            variant,
            epoch: epoch + 1,
            of: settings.epochs,
            loss,
            validation_loss,
        });
        if follows.is_break() {
            return Err(DigitacError::Stopped);
        }
        if validation_loss < best_loss {
            (best, best_loss, since_best) = (parameters.clone(), validation_loss, 0);
            continue;
        }
        since_best += 1;
        if since_best % settings.patience == 0 {
            learning_rate = (learning_rate * settings.rate_factor).max(SMALLEST_RATE);
        }
        if since_best >= settings.stop_patience {
            break;
        }
    }
    Ok((best, history))
}

/// Presses in batches of about the size of the settings.
fn gather(
    physics: &Physics,
    presses: &[PairedPress],
    settings: &TrainSettings,
    seed_number: u64,
) -> Vec<Batch> {
    let n_frames = presses
        .iter()
        .map(|p| p.features.n_frames().min(settings.max_frames))
        .max()
        .unwrap_or(1);
    let size = settings.batch_frames.div_ceil(n_frames.max(1));
    batches(&(0..presses.len()).collect::<Vec<_>>(), size, seed_number)
        .iter()
        .map(|batch| {
            let chosen: Vec<&PairedPress> = batch.iter().map(|&index| &presses[index]).collect();
            Batch::new(physics, &chosen, settings.max_frames)
        })
        .collect()
}

fn mean_loss(parameters: &Parameters, physics: &Physics, batches: &[Batch]) -> f64 {
    let counted: f64 = batches.iter().map(Batch::n_counted).sum();
    let loss = |batch: &Batch| f64::from(batch.loss(parameters, physics));
    batches
        .iter()
        .map(|batch| batch.n_counted() * loss(batch))
        .sum::<f64>()
        / counted
}
