//! How variants are trained.

use serde::{Deserialize, Serialize};

use crate::features::TIME_CONSTANTS_S;
use crate::{DigitacError, Variant};

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
    /// Largest norm of the gradient, over all parameters together.
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
    /// Largest correction, as a share of the size of the frame's readings. It bounds the error
    /// that it can make far from the training presses.
    pub correction_limit: f64,
    /// Time constants of the barometers' memory that the fit starts from, s.
    pub time_constants_s: Vec<f64>,
    /// Whether barometers may read otherwise than in proportion to the pressure.
    pub port_law: bool,
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
            port_law: true,
            batch_frames: 512,
            max_frames: 128,
        }
    }
}

impl TrainSettings {
    pub(crate) fn check(&self) -> Result<(), DigitacError> {
        let wrong = |setting, expected, found: String| {
            Err(DigitacError::Setting {
                setting,
                expected,
                found,
            })
        };
        if self.learning_rate.is_nan() || self.learning_rate <= 0.0 {
            return wrong(
                "learning_rate",
                "a number above zero",
                self.learning_rate.to_string(),
            );
        }
        if self.max_frames == 0 || self.batch_frames == 0 {
            let found = format!("{}, {}", self.max_frames, self.batch_frames);
            return wrong("max_frames, batch_frames", "1 or more", found);
        }
        if self
            .time_constants_s
            .iter()
            .any(|tau| tau.is_nan() || *tau <= 0.0)
        {
            return wrong(
                "time_constants_s",
                "times above zero",
                format!("{:?}", self.time_constants_s),
            );
        }
        if self.paper_hidden.contains(&0) || self.correction_hidden.contains(&0) {
            return wrong(
                "paper_hidden, correction_hidden",
                "widths above zero",
                "a width of zero".into(),
            );
        }
        Ok(())
    }

    /// Widths of a variant's hidden layers.
    pub(crate) fn hidden(&self, variant: Variant) -> &[usize] {
        match variant {
            Variant::Paper => &self.paper_hidden,
            _ => &self.correction_hidden,
        }
    }

    /// Deviation of the noise on what a variant's perceptron sees.
    pub(crate) fn noise(&self, variant: Variant) -> f64 {
        match variant {
            Variant::Paper => self.paper_noise,
            _ => self.correction_noise,
        }
    }
}
