//! Trains the variants, and chooses among them by their errors on validation presses.

use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use super::adamw::AdamW;
use super::batch::{Batch, batches, thin};
use super::{Split, TrainSettings};
use crate::evaluation::{Scale, Score, score};
use crate::features::{Gains, Sample};
use crate::network::{Normalization, Parameters, Physics};
use crate::{DigitacError, PairedPress, Twin, Variant, seed};

/// The learning rate does not fall below this.
const SMALLEST_RATE: f64 = 1e-6;

/// The progress of a training.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The variant in training.
    pub variant: Variant,
    /// Epochs done.
    pub epoch: usize,
    /// Epochs at most.
    pub of: usize,
    /// Loss on training presses: mean absolute deviation over the largest reading.
    pub loss: f64,
    /// The same on validation presses.
    pub validation_loss: f64,
}

/// Losses along a training.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Epoch {
    /// Learning rate.
    pub learning_rate: f64,
    /// Loss on training presses, noise included.
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

/// Trains every variant of the settings, in their order.
pub fn train(
    presses: &[PairedPress],
    taxels: &[String],
    split: &Split,
    scale: &Scale,
    settings: &TrainSettings,
    progress: &mut dyn FnMut(Progress),
) -> Result<Vec<Trained>, DigitacError> {
    settings.check()?;
    let parts = Parts::new(presses, taxels, split)?;
    let samples = |presses: &[&PairedPress]| -> Vec<PairedPress> {
        presses
            .iter()
            .map(|press| thin(press, settings.max_frames))
            .collect()
    };
    let thinned = samples(&parts.train);
    let samples: Vec<Sample<'_>> = thinned.iter().map(Sample::from).collect();
    let is_static = parts.train.iter().all(|press| press.features.n_frames() < 2);
    let elastic = Gains::fit(&samples, &[]).0;
    let remembering = if is_static || !settings.variants.iter().any(|v| v.has_memory()) {
        elastic.clone()
    } else {
        Gains::fit_with_time_constants(&samples, &settings.time_constants_s)
    };
    let no_scale = || DigitacError::TooFew {
        expected: "usable readings above zero to train with".into(),
        found: "none".into(),
    };
    let normalization = Normalization::of(&parts.train).ok_or_else(no_scale)?;
    settings
        .variants
        .iter()
        .map(|&variant| {
            let physics = Physics {
                variant,
                gains: if variant.has_memory() {
                    remembering.clone()
                } else {
                    elastic.clone()
                },
                normalization: normalization.clone(),
                correction_limit: settings.correction_limit,
            };
            let (parameters, history) = train_variant(&physics, &parts, settings, progress)?;
            let twin = Twin::new(taxels.to_vec(), physics, parameters);
            let predictions: Vec<_> = parts
                .validation
                .iter()
                .map(|press| twin.predict(&press.features))
                .collect();
            let validation = score(parts.validation.iter().copied(), &predictions, scale);
            Ok(Trained {
                twin,
                validation,
                history,
            })
        })
        .collect()
}

/// The variant with the smallest headline error on validation presses; never chosen by test presses. Of
/// equals, the first.
#[must_use]
pub fn choose(trained: &[Trained]) -> Option<&Trained> {
    let error = |t: &Trained| t.validation.overall.nearest_in_contact.percent;
    trained.iter().min_by(|a, b| error(a).total_cmp(&error(b)))
}

struct Parts<'a> {
    train: Vec<&'a PairedPress>,
    validation: Vec<&'a PairedPress>,
}

impl<'a> Parts<'a> {
    fn new(presses: &'a [PairedPress], taxels: &[String], split: &Split) -> Result<Self, DigitacError> {
        let part = |indices: &[usize]| -> Result<Vec<&'a PairedPress>, DigitacError> {
            let missing = |index: &usize| DigitacError::TooFew {
                expected: format!("a press number {index}, as the split says"),
                found: format!("{} presses", presses.len()),
            };
            indices
                .iter()
                .map(|index| presses.get(*index).ok_or_else(|| missing(index)))
                .collect()
        };
        let parts = Self {
            train: part(&split.train)?,
            validation: part(&split.validation)?,
        };
        for press in parts.train.iter().chain(&parts.validation) {
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
        if parts.train.is_empty() || parts.validation.is_empty() {
            return Err(DigitacError::TooFew {
                expected: "presses to train and to validate with".into(),
                found: format!("{} and {}", parts.train.len(), parts.validation.len()),
            });
        }
        Ok(parts)
    }
}

/// The parameters with the smallest loss on validation presses, and the losses of each epoch.
fn train_variant(
    physics: &Physics,
    parts: &Parts<'_>,
    settings: &TrainSettings,
    progress: &mut dyn FnMut(Progress),
) -> Result<(Parameters, Vec<Epoch>), DigitacError> {
    let variant = physics.variant;
    let train = gather(physics, &parts.train, settings);
    let validation = gather(physics, &parts.validation, settings);
    let mut random = seed::stream(settings.seed, &format!("training/{variant}"));
    let mut parameters = Parameters::new(physics, settings.hidden(variant), settings.seed);
    let mut optimizer = AdamW::new(
        &parameters,
        settings.weight_decay as f32,
        settings.gradient_norm as f32,
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
            optimizer.step(learning_rate, &mut parameters, &gradient);
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
        progress(Progress {
            variant,
            epoch: epoch + 1,
            of: settings.epochs,
            loss,
            validation_loss,
        });
        if validation_loss < best_loss {
            (best, best_loss, since_best) = (parameters.clone(), validation_loss, 0);
            continue;
        }
        since_best += 1;
        if since_best % settings.patience.max(1) == 0 {
            learning_rate = (learning_rate * settings.rate_factor).max(SMALLEST_RATE);
        }
        if since_best >= settings.stop_patience {
            break;
        }
    }
    Ok((best, history))
}

/// Presses in batches of about the size of the settings.
fn gather(physics: &Physics, presses: &[&PairedPress], settings: &TrainSettings) -> Vec<Batch> {
    let n_frames = presses
        .iter()
        .map(|p| p.features.n_frames().min(settings.max_frames))
        .max()
        .unwrap_or(1);
    let size = settings.batch_frames.div_ceil(n_frames.max(1));
    batches(&(0..presses.len()).collect::<Vec<_>>(), size, settings.seed)
        .iter()
        .map(|batch| {
            let chosen: Vec<&PairedPress> = batch.iter().map(|&index| presses[index]).collect();
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
