//! Teaches the variants, and chooses among them by what they do on validation presses.

use burn::grad_clipping::GradientClippingConfig;
use burn::optim::{AdamWConfig, GradientsParams};
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use crate::batch::Batch;
use crate::gains::{Gains, Sample};
use crate::network::{Network, Physics, device};
use crate::normalization::Normalization;
use crate::split::batches;
use crate::{DigitacError, PairedPress, Score, Split, TIME_CONSTANTS_S, Twin, Variant, metric, seed};

/// The learning rate does not fall below this.
const SMALLEST_RATE: f64 = 1e-6;

/// How variants are trained. Loss, optimizer, rate, its decay, clipping and noise are the TwinTac paper's
/// (arXiv 2509.10063, section III-C).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrainSettings {
    /// What to train.
    pub variants: Vec<Variant>,
    /// Seed of weights, batches and noise.
    pub seed: u64,
    /// Passes over the training presses, at most.
    pub epochs: usize,
    /// Initial learning rate.
    pub learning_rate: f64,
    /// Factor on the learning rate when the validation loss stops falling.
    pub rate_factor: f64,
    /// Epochs without a better validation loss before the rate falls.
    pub patience: usize,
    /// Epochs without a better validation loss before training stops.
    pub stop_patience: usize,
    /// Largest norm of a parameter's gradient.
    pub gradient_norm: f64,
    /// AdamW's decay of weights: it pulls physical variants back to the fitted physics.
    pub weight_decay: f64,
    /// Deviation of the noise on the paper variant's features, which have unit deviation.
    pub paper_noise: f64,
    /// Deviation of the noise on the pressures that a correction sees, which have unit size.
    pub correction_noise: f64,
    /// Widths of the paper variant's hidden layers; the paper does not state them.
    pub paper_hidden: Vec<usize>,
    /// Widths of a correction's hidden layers.
    pub correction_hidden: Vec<usize>,
    /// Largest correction, as a share of the size of the frame's readings. It bounds what the twin can say
    /// where it was never pressed.
    pub correction_limit: f64,
    /// Start of the memory's time constants, s.
    pub time_constants_s: Vec<f64>,
    /// Frames in a batch, about.
    pub batch_frames: usize,
    /// Frames of one press used in training; longer presses are thinned.
    pub max_frames: usize,
}

impl Default for TrainSettings {
    fn default() -> Self {
        Self {
            variants: Variant::ALL.to_vec(),
            seed: 1,
            epochs: 600,
            learning_rate: 1e-3,
            rate_factor: 0.3,
            patience: 20,
            stop_patience: 60,
            gradient_norm: 1.0,
            weight_decay: 1e-2,
            paper_noise: 0.05,
            correction_noise: 0.02,
            paper_hidden: vec![64, 64],
            correction_hidden: vec![24, 24],
            correction_limit: 0.3,
            time_constants_s: TIME_CONSTANTS_S.to_vec(),
            batch_frames: 512,
            max_frames: 128,
        }
    }
}

/// How far training is.
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
    /// How it got there.
    pub history: Vec<Epoch>,
}

/// Trains every variant of the settings, in their order.
pub fn train(
    presses: &[PairedPress],
    taxels: &[String],
    split: &Split,
    scale: &metric::Scale,
    settings: &TrainSettings,
    progress: &mut dyn FnMut(Progress),
) -> Result<Vec<Trained>, DigitacError> {
    check(settings)?;
    let parts = Parts::new(presses, taxels, split)?;
    let samples = |presses: &[&PairedPress]| -> Vec<PairedPress> {
        presses
            .iter()
            .map(|press| crate::batch::thin(press, settings.max_frames))
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
            let (network, history) = train_variant(&physics, &parts, settings, progress)?;
            let hidden = hidden(variant, settings).to_vec();
            let twin = Twin::with_weights(taxels.to_vec(), physics, hidden, network.weights())
                .map_err(|problem| DigitacError::model(variant.name().as_ref(), problem))?;
            let predictions: Vec<_> = parts
                .validation
                .iter()
                .map(|press| twin.predict(&press.features))
                .collect();
            let validation = metric::score(parts.validation.iter().copied(), &predictions, scale);
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

fn check(settings: &TrainSettings) -> Result<(), DigitacError> {
    let wrong = |setting, expected, found: String| {
        Err(DigitacError::Setting {
            setting,
            expected,
            found,
        })
    };
    if settings.learning_rate.is_nan() || settings.learning_rate <= 0.0 {
        return wrong(
            "learning_rate",
            "a number above zero",
            settings.learning_rate.to_string(),
        );
    }
    if settings.max_frames == 0 || settings.batch_frames == 0 {
        let found = format!("{}, {}", settings.max_frames, settings.batch_frames);
        return wrong("max_frames, batch_frames", "1 or more", found);
    }
    if settings
        .time_constants_s
        .iter()
        .any(|tau| tau.is_nan() || *tau <= 0.0)
    {
        return wrong(
            "time_constants_s",
            "times above zero",
            format!("{:?}", settings.time_constants_s),
        );
    }
    if settings.paper_hidden.contains(&0) || settings.correction_hidden.contains(&0) {
        return wrong(
            "paper_hidden, correction_hidden",
            "widths above zero",
            "a width of zero".into(),
        );
    }
    Ok(())
}

fn hidden(variant: Variant, settings: &TrainSettings) -> &[usize] {
    match variant {
        Variant::Paper => &settings.paper_hidden,
        _ => &settings.correction_hidden,
    }
}

fn train_variant(
    physics: &Physics,
    parts: &Parts<'_>,
    settings: &TrainSettings,
    progress: &mut dyn FnMut(Progress),
) -> Result<(Network, Vec<Epoch>), DigitacError> {
    let variant = physics.variant;
    let device = device().autodiff();
    let gather = |presses: &[&PairedPress]| -> Vec<Batch> {
        let frames = presses
            .iter()
            .map(|p| p.features.n_frames().min(settings.max_frames))
            .max()
            .unwrap_or(1);
        let size = settings.batch_frames.div_ceil(frames.max(1));
        batches(&(0..presses.len()).collect::<Vec<_>>(), size, settings.seed)
            .iter()
            .map(|batch| {
                let chosen: Vec<&PairedPress> = batch.iter().map(|&index| presses[index]).collect();
                Batch::new(physics, &chosen, settings.max_frames, &device)
            })
            .collect()
    };
    let (train, validation) = (gather(&parts.train), gather(&parts.validation));
    let mut optimizer = AdamWConfig::new()
        .with_weight_decay(settings.weight_decay as f32)
        .with_grad_clipping(Some(GradientClippingConfig::Norm(settings.gradient_norm as f32)))
        .init();
    let noise = if variant == Variant::Paper {
        settings.paper_noise
    } else {
        settings.correction_noise
    };
    let mut random = seed::stream(settings.seed, &format!("training/{variant}"));
    let mut network = Network::new(physics, hidden(variant, settings), settings.seed, &device);
    let mut learning_rate = settings.learning_rate;
    let start = mean_loss(&network, physics, &validation);
    let (mut best, mut best_loss, mut since_best) = (network.clone(), start, 0);
    let mut history = Vec::new();
    let mut order: Vec<usize> = (0..train.len()).collect();
    for epoch in 0..settings.epochs {
        order.shuffle(&mut random);
        let mut sum = 0.0;
        for &index in &order {
            let loss = train[index].loss(&network, physics, Some((noise, &mut random)));
            sum += f64::from(loss.clone().into_scalar::<f32>());
            let gradients = GradientsParams::from_grads(loss.backward(), &network);
            network = optimizer.step(learning_rate, network, gradients);
        }
        let loss = sum / train.len() as f64;
        let validation_loss = mean_loss(&network, physics, &validation);
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
            (best, best_loss, since_best) = (network.clone(), validation_loss, 0);
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

fn mean_loss(network: &Network, physics: &Physics, batches: &[Batch]) -> f64 {
    let counted: f64 = batches.iter().map(Batch::n_counted).sum();
    let loss = |batch: &Batch| f64::from(batch.loss(network, physics, None).into_scalar::<f32>());
    batches
        .iter()
        .map(|batch| batch.n_counted() * loss(batch))
        .sum::<f64>()
        / counted
}
