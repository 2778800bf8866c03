//! Training sets of shape classifiers.

use serde::{Deserialize, Serialize};
use twintac_classify::Sampling;

/// Source of the simulated trials of a training set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Simulated {
    /// No simulated trials.
    None,
    /// This project's twin.
    Twin,
    /// The paper's network: a perceptron on its stress feature.
    PaperTwin,
}

impl Simulated {
    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Twin => "twin",
            Self::PaperTwin => "paper-twin",
        }
    }

    /// Name of the file of its trials.
    pub(super) fn file(self) -> String {
        format!("{}.parquet", self.name())
    }
}

/// A training set: the numbers and sources of its trials, and how they are sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mixture {
    /// Trials of each shape on the bench.
    pub real_trials: usize,
    /// Source of the simulated trials.
    pub simulated: Simulated,
    /// Simulated trials of each shape.
    pub simulated_trials: usize,
    /// How a press becomes a series.
    pub sampling: Sampling,
}
