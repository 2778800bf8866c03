//! What a classifier of shapes is trained with.

use serde::{Deserialize, Serialize};
use twintac_classify::Sampling;

/// Where the simulated trials of a training come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Simulated {
    /// There are none.
    None,
    /// This project's twin.
    Twin,
    /// The paper's twin: its stress feature and its perceptron.
    PaperTwin,
}

impl Simulated {
    /// The name used in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Twin => "twin",
            Self::PaperTwin => "paper-twin",
        }
    }

    /// The file of the trials.
    pub(super) fn file(self) -> String {
        format!("{}.parquet", self.name())
    }
}

/// A way to train: what a classifier sees, and of how many trials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mixture {
    /// Trials of each shape on the bench.
    pub real_trials: usize,
    /// Where the simulated ones come from.
    pub simulated: Simulated,
    /// How many of them each shape has.
    pub simulated_trials: usize,
    /// How a press becomes a series.
    pub sampling: Sampling,
}
