//! Settings of the training.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, Ranges};

use crate::Variant;
use crate::features::{TIME_CONSTANTS_S, check_time_constants};

/// Largest number of hidden layers of a perceptron, and their largest width.
pub(crate) const MOST_LAYERS: usize = 8;
pub(crate) const MOST_WIDTH: f64 = 1024.0;

/// Settings of the training. Loss, optimizer, learning rate, its decay, clipping and noise are
/// those of the TwinTac paper (arXiv 2509.10063, section III-C).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrainSettings {
    /// The variants to train. Default: all; on a surrogate of the gel (`FastGel`) all except the
    /// paper's, which needs stresses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub variants: Option<Vec<Variant>>,
    /// Largest number of passes over the training presses.
    pub epochs: usize,
    /// Initial learning rate.
    pub learning_rate: f64,
    /// Factor on the learning rate when the validation loss stops falling.
    pub rate_factor: f64,
    /// Epochs without a better validation loss after which the learning rate falls.
    pub patience: usize,
    /// Epochs without a better validation loss after which training stops.
    pub stop_patience: usize,
    /// Largest norm of the gradient of all parameters together.
    pub gradient_norm: f64,
    /// Weight decay of AdamW. It regularizes physical variants towards the fitted physics.
    pub weight_decay: f64,
    /// Standard deviation of the noise on the paper variant's features, which have unit deviation.
    pub paper_noise: f64,
    /// Standard deviation of the noise on the pressures that a correction sees, which have unit
    /// size.
    pub correction_noise: f64,
    /// Widths of the paper variant's hidden layers; the paper does not state them.
    pub paper_hidden: Vec<usize>,
    /// Widths of a correction's hidden layers.
    pub correction_hidden: Vec<usize>,
    /// Largest correction, as a fraction of the size of the frame's readings. It limits the error
    /// that the correction can cause far from the training presses.
    pub correction_limit: f64,
    /// Initial time constants of the barometers' viscoelastic relaxation, s.
    pub time_constants_s: Vec<f64>,
    /// Whether the response of a barometer to pressure may be nonlinear.
    pub port_law: bool,
    /// Approximate number of frames in a batch.
    pub batch_frames: usize,
    /// Largest number of frames of one press in training; longer presses are thinned.
    pub max_frames: usize,
}

impl Default for TrainSettings {
    fn default() -> Self {
        Self {
            variants: None,
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

impl Checked for TrainSettings {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            variants,
            epochs,
            learning_rate,
            rate_factor,
            patience,
            stop_patience,
            gradient_norm,
            weight_decay,
            paper_noise,
            correction_noise,
            paper_hidden,
            correction_hidden,
            correction_limit,
            time_constants_s,
            port_law: _,
            batch_frames,
            max_frames,
        } = self;
        if let Some(variants) = variants {
            let is_right = !variants.is_empty() && variants.len() == BTreeSet::from_iter(variants).len();
            let names = || variants.iter().map(|variant| variant.name()).collect::<Vec<_>>();
            let problem = || format!("is {:?}", names());
            ranges.that(
                "variants",
                is_right,
                problem,
                || "name one variant or more, each once",
            );
        }
        ranges.number("epochs", *epochs, 1.0..=100_000.0);
        ranges.number("learning_rate", *learning_rate, 1e-6..=1.0);
        ranges.number("rate_factor", *rate_factor, 0.01..=1.0);
        ranges.number("patience", *patience, 1.0..=100_000.0);
        ranges.number("stop_patience", *stop_patience, 1.0..=100_000.0);
        ranges.number("gradient_norm", *gradient_norm, 1e-6..=1e6);
        ranges.zero_or("weight_decay", *weight_decay, 1e-9..=10.0);
        ranges.zero_or("paper_noise", *paper_noise, 1e-6..=1.0);
        ranges.zero_or("correction_noise", *correction_noise, 1e-6..=1.0);
        for (field, widths) in [
            ("paper_hidden", paper_hidden),
            ("correction_hidden", correction_hidden),
        ] {
            ranges.numbers(field, widths, MOST_LAYERS, 1.0..=MOST_WIDTH);
        }
        ranges.zero_or("correction_limit", *correction_limit, 1e-3..=10.0);
        check_time_constants(ranges, time_constants_s);
        ranges.number("batch_frames", *batch_frames, 1.0..=1e6);
        // The relaxation of a press is a matrix of frames by frames.
        ranges.number("max_frames", *max_frames, 2.0..=4000.0);
    }
}

impl TrainSettings {
    /// The variants to train.
    pub(crate) fn variants(&self) -> &[Variant] {
        self.variants.as_deref().unwrap_or(&Variant::ALL)
    }

    /// Widths of a variant's hidden layers.
    pub(crate) fn hidden(&self, variant: Variant) -> &[usize] {
        match variant {
            Variant::Paper => &self.paper_hidden,
            _ => &self.correction_hidden,
        }
    }

    /// Standard deviation of the noise on the inputs of a variant's perceptron.
    pub(crate) fn noise(&self, variant: Variant) -> f64 {
        match variant {
            Variant::Paper => self.paper_noise,
            _ => self.correction_noise,
        }
    }
}

/// Settings and seed of a training.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrainedWith {
    /// The settings.
    #[serde(flatten)]
    pub settings: TrainSettings,
    /// Seed of weights, batches and noise.
    pub seed: u64,
}
