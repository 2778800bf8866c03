//! How much of the paper's experiments is made.

use std::path::Path;

use digitac::{BenchSettings, TrainSettings as TwinTraining};
use serde::{Deserialize, Serialize};
use twintac_classify::{Sampling, TrainSettings};
use twintac_lab::Reality;
use twintac_run::RunSettings;
use twintac_run::built_in::{BuiltIn, DEMO_PROTOCOL, PAPER_PROTOCOL, reality};
use twintac_simulate::SimulateSettings;
use twintac_work::WorkError;

use crate::mixture::{Mixture, Simulated};

/// Edges over a gel's height and over a contact's radius where it has to be quick.
const COARSE: f64 = 4.0;

/// Simulated trials of each shape in the paper.
pub(super) const PAPER_SIMULATED: usize = 96;

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
    /// The reality of the bench that presses.
    pub(super) fn reality(self) -> Result<Reality, WorkError> {
        match self {
            Self::Full => reality(Some(Path::new("harder"))),
            Self::Quick => self.simple_reality(),
        }
    }

    /// A bench without what makes it hard. A quick one has a coarse gel.
    pub(super) fn simple_reality(self) -> Result<Reality, WorkError> {
        let mut simple = reality(None)?;
        if self == Self::Quick {
            simple.gel.edges_per_height = COARSE;
            simple.gel.edges_per_contact_radius = COARSE;
        }
        Ok(simple)
    }

    /// Presses that the gel's material is fitted to.
    pub(super) fn material_presses(self) -> usize {
        match self {
            Self::Full => 7,
            Self::Quick => 2,
        }
    }

    /// Steps at most of the fit of the material.
    pub(super) fn material_steps(self) -> u32 {
        match self {
            Self::Full => 30,
            Self::Quick => 4,
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
            Self::Quick => 2,
        }
    }

    /// Trials of each shape that the twin makes.
    pub(super) fn simulated_trials(self) -> u32 {
        match self {
            Self::Full => PAPER_SIMULATED as u32,
            Self::Quick => 4,
        }
    }

    /// Simulated trials of each shape that are trained with, but for the most.
    fn fewer_simulated(self) -> &'static [usize] {
        match self {
            Self::Full => &[20, 48],
            Self::Quick => &[],
        }
    }

    /// Trials of each shape on the bench that learning is tried with.
    fn curve(self) -> &'static [usize] {
        match self {
            Self::Full => &[0, 1, 2, 5, 10, 20],
            Self::Quick => &[0, 2],
        }
    }

    /// What shapes are learned from: over trials of the bench without simulated ones, with the paper's number of those of either twin, and with all of this
    /// twin; over simulated trials with none, some and all of the bench; and with series over time instead of load.
    pub(super) fn mixtures(self) -> Vec<Mixture> {
        let all = self.simulated_trials() as usize;
        let papers = PAPER_SIMULATED.min(all);
        let mut mixtures = Vec::new();
        let mut add = |real_trials, simulated, simulated_trials, sampling| {
            let mixture = Mixture {
                real_trials,
                simulated,
                simulated_trials,
                sampling,
            };
            if real_trials + simulated_trials > 0 && !mixtures.contains(&mixture) {
                mixtures.push(mixture);
            }
        };
        for &real in self.curve() {
            add(real, Simulated::None, 0, Sampling::Load);
            add(real, Simulated::PaperTwin, papers, Sampling::Load);
            add(real, Simulated::Twin, papers, Sampling::Load);
            add(real, Simulated::Twin, all, Sampling::Load);
        }
        let most = self.real_trials() as usize;
        for &simulated in self.fewer_simulated() {
            for real in [0, most / 4, most] {
                add(real, Simulated::Twin, simulated, Sampling::Load);
            }
        }
        add(most, Simulated::None, 0, Sampling::Time);
        add(most, Simulated::Twin, papers, Sampling::Time);
        mixtures
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
                bench: BenchSettings {
                    // 168 presses of seven shapes in a plane tell where the ports are, and the gel is fitted.
                    port_shift_limit_mm: 1.2,
                    port_shift_pull: 1e-5,
                    smooth_factor_pull: 1e-3,
                    ..BenchSettings::default()
                },
                train: TwinTraining {
                    max_frames: 1000, // the paper trains on all frames
                    ..TwinTraining::default()
                },
                ..RunSettings::default()
            },
            Self::Quick => RunSettings {
                simulate: SimulateSettings {
                    edges_per_height: COARSE,
                    edges_per_contact_radius: COARSE,
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
                n_networks: 1,
                epochs: 10,
                least_steps: 100,
                ..TrainSettings::default()
            },
        }
    }
}
