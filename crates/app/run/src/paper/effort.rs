//! How much of the paper's experiments is made.

use digitac::TrainSettings as TwinTraining;
use serde::{Deserialize, Serialize};
use twintac_classify::TrainSettings;
use twintac_simulate::SimulateSettings;

use crate::RunSettings;
use crate::built_in::{BuiltIn, DEMO_PROTOCOL, PAPER_PROTOCOL};

/// How much of the paper's experiments is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Effort {
    /// The paper's counts: hours.
    Full,
    /// Few presses of a simple bench: minutes. Its figures show that everything runs, and nothing else.
    Quick,
}

impl Effort {
    /// The reality of the bench that presses, by its name.
    pub(super) fn reality(self) -> &'static str {
        match self {
            Self::Full => "harder",
            Self::Quick => "default",
        }
    }

    /// The presses that the twin learns from.
    pub(super) fn data(self) -> BuiltIn {
        match self {
            Self::Full => PAPER_PROTOCOL,
            Self::Quick => DEMO_PROTOCOL,
        }
    }

    /// Trials of each shape that the bench presses to learn from, and as many to test with.
    pub(super) fn real_trials(self) -> u32 {
        match self {
            Self::Full => 20,
            Self::Quick => 4,
        }
    }

    /// Trials of each shape that the twin makes.
    pub(super) fn simulated_trials(self) -> u32 {
        match self {
            Self::Full => 96,
            Self::Quick => 8,
        }
    }

    /// Trials of each shape on the bench that learning is tried with.
    pub(super) fn curve(self) -> &'static [usize] {
        match self {
            Self::Full => &[0, 1, 2, 5, 10, 20],
            Self::Quick => &[0, 4],
        }
    }

    /// Seeds, from 1 to this.
    pub(super) fn seeds(self) -> u64 {
        match self {
            Self::Full => 5,
            Self::Quick => 1,
        }
    }

    pub(super) fn run_settings(self) -> RunSettings {
        match self {
            Self::Full => RunSettings {
                train: TwinTraining {
                    max_frames: 1000, // the paper trains on all frames
                    ..TwinTraining::default()
                },
                ..RunSettings::default()
            },
            Self::Quick => RunSettings {
                simulate: SimulateSettings {
                    edges_per_height: 6.0,
                    edges_per_contact_radius: 5.0,
                    ..SimulateSettings::default()
                },
                train: TwinTraining {
                    epochs: 40,
                    ..TwinTraining::default()
                },
                ..RunSettings::default()
            },
        }
    }

    pub(super) fn classifier(self) -> TrainSettings {
        match self {
            Self::Full => TrainSettings::default(),
            Self::Quick => TrainSettings {
                epochs: 10,
                least_steps: 100,
                ..TrainSettings::default()
            },
        }
    }
}
