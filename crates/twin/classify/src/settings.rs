//! Size and training of a classifier.

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, Ranges};

/// Size and training of a classifier. The TwinTac paper states none of these values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrainSettings {
    /// Number of networks whose probabilities are averaged.
    pub n_networks: usize,
    /// Length of a token.
    pub width: usize,
    /// Number of encoder layers.
    pub n_layers: usize,
    /// Number of attention heads in each layer; it divides the width.
    pub n_heads: usize,
    /// Width of each layer's perceptron.
    pub hidden: usize,
    /// Passes over the trials. Small training sets get more: see
    /// [`least_steps`](Self::least_steps).
    pub epochs: usize,
    /// Smallest number of steps of the optimizer, for small training sets.
    pub least_steps: usize,
    /// Number of trials in a step.
    pub batch: usize,
    /// Largest learning rate. The rate rises over the first tenth of the steps and falls to zero
    /// along a cosine.
    pub learning_rate: f64,
    /// Weight decay of AdamW.
    pub weight_decay: f64,
    /// Largest norm of the gradient; longer gradients are shortened to it.
    pub gradient_norm: f64,
    /// Relative standard deviation of the random gain of each taxel of a trial in training.
    pub gain_noise: f64,
    /// Standard deviation of the noise on each sample in training, as a fraction of the sample's
    /// largest reading, or of the trial's if samples are at equal steps of time.
    pub sample_noise: f64,
}

impl Default for TrainSettings {
    fn default() -> Self {
        Self {
            n_networks: 4,
            width: 32,
            n_layers: 2,
            n_heads: 4,
            hidden: 64,
            epochs: 30,
            least_steps: 1500,
            batch: 32,
            learning_rate: 2e-3,
            weight_decay: 0.05,
            gradient_norm: 1.0,
            gain_noise: 0.03,
            sample_noise: 0.005,
        }
    }
}

impl Checked for TrainSettings {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            n_networks,
            width,
            n_layers,
            n_heads,
            hidden,
            epochs,
            least_steps,
            batch,
            learning_rate,
            weight_decay,
            gradient_norm,
            gain_noise,
            sample_noise,
        } = self;
        ranges.number("n_networks", *n_networks, 1.0..=100.0);
        ranges.number("width", *width, 1.0..=1024.0);
        ranges.number("n_layers", *n_layers, 1.0..=32.0);
        ranges.number("n_heads", *n_heads, 1.0..=64.0);
        let divides = *n_heads > 0 && width.is_multiple_of(*n_heads);
        let problem = || format!("is {n_heads}");
        ranges.that("n_heads", divides, problem, || {
            format!("give a divisor of the width, {width}")
        });
        ranges.number("hidden", *hidden, 1.0..=8192.0);
        ranges.number("epochs", *epochs, 1.0..=100_000.0);
        ranges.zero_or("least_steps", *least_steps, 1.0..=1e7);
        ranges.number("batch", *batch, 1.0..=1e6);
        ranges.number("learning_rate", *learning_rate, 1e-6..=1.0);
        ranges.zero_or("weight_decay", *weight_decay, 1e-9..=10.0);
        ranges.number("gradient_norm", *gradient_norm, 1e-6..=1e6);
        ranges.zero_or("gain_noise", *gain_noise, 1e-6..=1.0);
        ranges.zero_or("sample_noise", *sample_noise, 1e-6..=1.0);
    }
}
