//! The extent of the experiments: full, or a quick trial.

use std::path::Path;

use digitac::{BenchSettings, TrainSettings as TwinTraining};
use serde::{Deserialize, Serialize};
use twintac_classify::{Sampling, TrainSettings};
use twintac_lab::EmulatorConfiguration;
use twintac_run::RunSettings;
use twintac_run::built_in::{BuiltIn, DEMO_PROTOCOL, PAPER_PROTOCOL, emulator};
use twintac_simulate::SimulateSettings;
use twintac_work::WorkError;

use crate::mixture::{Mixture, Simulated};

/// Edges over a gel's height and over a contact's radius in the quick trial.
const COARSE: f64 = 3.0;

/// Simulated trials of each shape in the paper.
pub(super) const PAPER_SIMULATED: usize = 96;

/// The extent of the experiments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Effort {
    /// The paper's counts: takes hours.
    Full,
    /// Few presses of a simple bench: takes minutes. Its figures show only that everything runs.
    Quick,
}

impl Effort {
    /// The emulator configuration of the bench.
    pub(super) fn emulator(self) -> Result<EmulatorConfiguration, WorkError> {
        match self {
            Self::Full => emulator(Some(Path::new("harder"))),
            Self::Quick => self.simple_emulator(),
        }
    }

    /// The default emulator configuration, which is easier. The quick trial has a coarse gel.
    pub(super) fn simple_emulator(self) -> Result<EmulatorConfiguration, WorkError> {
        let mut simple = emulator(None)?;
        if self == Self::Quick {
            simple.gel.edges_per_height = COARSE;
            simple.gel.edges_per_contact_radius = COARSE;
        }
        Ok(simple)
    }

    /// Number of presses to which the gel's material is fitted.
    pub(super) fn material_presses(self) -> usize {
        match self {
            Self::Full => 7,
            Self::Quick => 2,
        }
    }

    /// Most iterations of the fit of the material.
    pub(super) fn material_steps(self) -> u32 {
        match self {
            Self::Full => 30,
            Self::Quick => 1,
        }
    }

    /// The protocol of the twin's training presses.
    pub(super) fn data(self) -> BuiltIn {
        match self {
            Self::Full => PAPER_PROTOCOL,
            Self::Quick => DEMO_PROTOCOL,
        }
    }

    /// Trials of each shape on the bench for training; as many more are for testing.
    pub(super) fn real_trials(self) -> u32 {
        match self {
            Self::Full => 20,
            Self::Quick => 2,
        }
    }

    /// Trials of each shape that the twin simulates.
    pub(super) fn simulated_trials(self) -> u32 {
        match self {
            Self::Full => PAPER_SIMULATED as u32,
            Self::Quick => 4,
        }
    }

    /// Smaller numbers of simulated trials of each shape for training.
    fn fewer_simulated(self) -> &'static [usize] {
        match self {
            Self::Full => &[20, 48],
            Self::Quick => &[],
        }
    }

    /// Numbers of trials of each shape on the bench for training.
    fn curve(self) -> &'static [usize] {
        match self {
            Self::Full => &[0, 1, 2, 5, 10, 20],
            Self::Quick => &[0, 2],
        }
    }

    /// The training sets of the classifiers: for each number of bench trials, without simulated
    /// ones, with the paper's number of simulated ones of either twin, and with all of this
    /// project's twin; for smaller numbers of simulated trials, with none, a quarter and all of the
    /// bench trials; and with series over time instead of load.
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

    /// Number of seeds, from 1 on.
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
                    // 168 presses of seven shapes over a plane determine the port positions, and
                    // the gel is fitted separately.
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
