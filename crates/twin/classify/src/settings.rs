//! How a classifier is built and trained.

use serde::{Deserialize, Serialize};

use crate::ClassifyError;

/// Size and training of a classifier. The TwinTac paper states none of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrainSettings {
    /// Networks that vote.
    pub n_networks: usize,
    /// Numbers in a token.
    pub width: usize,
    /// Encoder layers.
    pub n_layers: usize,
    /// Heads of attention in each; they divide the width.
    pub n_heads: usize,
    /// Width of each layer's perceptron.
    pub hidden: usize,
    /// Passes over the trials. Few trials get more: see [`least_steps`](Self::least_steps).
    pub epochs: usize,
    /// Steps of the optimizer at least, however few trials there are.
    pub least_steps: usize,
    /// Trials of a step.
    pub batch: usize,
    /// Largest learning rate; it rises over the first tenth of the steps and falls to zero along a cosine.
    pub learning_rate: f64,
    /// AdamW's decay of weights.
    pub weight_decay: f64,
    /// Longest gradient.
    pub gradient_norm: f64,
    /// Relative deviation of the gain that each taxel of a trial gets in training.
    pub gain_noise: f64,
    /// Deviation of the noise on each sample in training, of the trial's largest reading.
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

impl TrainSettings {
    pub(crate) fn check(&self) -> Result<(), ClassifyError> {
        let sizes = [
            ("n_networks", self.n_networks),
            ("width", self.width),
            ("n_layers", self.n_layers),
            ("n_heads", self.n_heads),
            ("hidden", self.hidden),
            ("epochs", self.epochs),
            ("batch", self.batch),
        ];
        for (setting, size) in sizes {
            if size == 0 {
                return Err(ClassifyError::Setting {
                    setting,
                    expected: "one or more",
                    found: "0".to_owned(),
                });
            }
        }
        if !self.width.is_multiple_of(self.n_heads) {
            return Err(ClassifyError::Setting {
                setting: "n_heads",
                expected: "a divisor of the width",
                found: self.n_heads.to_string(),
            });
        }
        Ok(())
    }
}
