//! `metrics.json`: the figures of a run, for programs.

use std::collections::{BTreeMap, BTreeSet};

use digitac::{CertaintyScore, Errors, Evaluation, Repeatability, Score};
use serde::{Deserialize, Serialize};
use twintac_recording::Provenance;

/// Errors in % of the largest reading of the file that they belong to. A mean over nothing is `None`: null in files.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// Mean absolute error of the nearest taxel while in contact.
    pub nearest_in_contact_percent: Option<f64>,
    /// Mean absolute error of all taxels in all frames.
    pub all_percent: Option<f64>,
    /// Mean absolute error of the presses' largest readings.
    pub peak_percent: Option<f64>,
    /// Frames behind the headline.
    pub frames_in_contact: usize,
}

impl From<&Errors> for Figures {
    fn from(errors: &Errors) -> Self {
        Self {
            nearest_in_contact_percent: errors.nearest_in_contact.percent,
            all_percent: errors.all.percent,
            peak_percent: errors.peak.percent,
            frames_in_contact: errors.nearest_in_contact.count,
        }
    }
}

/// The twin's figures, taken apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwinFigures {
    /// Overall.
    #[serde(flatten)]
    pub overall: Figures,
    /// By file.
    pub by_file: BTreeMap<String, Figures>,
    /// By taxel.
    pub by_taxel: BTreeMap<String, Figures>,
    /// Frames deeper than the simulation reached. What it ends with stands for them, straight on; they are scored all the same.
    pub frames_not_simulated: usize,
    /// All frames.
    #[serde(default)]
    pub frames: usize,
}

impl TwinFigures {
    pub(crate) fn new(score: &Score, taxels: &[String]) -> Self {
        Self {
            overall: Figures::from(&score.overall),
            by_file: score
                .by_file
                .iter()
                .map(|(file, errors)| (file.clone(), errors.into()))
                .collect(),
            by_taxel: taxels
                .iter()
                .cloned()
                .zip(score.by_taxel.iter().map(Figures::from))
                .collect(),
            frames_not_simulated: score.n_frames_not_simulated,
            frames: score.n_frames,
        }
    }
}

/// What the twin is compared with, on the same presses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BaselineFigures {
    /// Nothing is ever felt.
    pub zero: Figures,
    /// A polynomial of depth and place, fitted to the twin's training presses.
    pub polynomial: Option<Figures>,
    /// A power of depth times a function of distance, and barometers as the twin has them, fitted to the same presses.
    pub kernel: Option<Figures>,
}

/// All figures of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Metrics {
    /// The sensor's name.
    pub sensor: String,
    /// Where the readings come from.
    pub provenance: Provenance,
    /// What the figures mean.
    pub definition: String,
    /// Taxels left out of the headline.
    pub taxels_left_out: Vec<String>,
    /// The variant behind the headline.
    pub variant: String,
    /// Presses that the twin never saw.
    pub held_out_presses: usize,
    /// The twin's errors on them.
    pub twin: TwinFigures,
    /// The same with no taxel left out, if some were.
    pub twin_all_taxels: Option<Figures>,
    /// What to beat.
    pub baselines: BaselineFigures,
    /// What two presses of the same place, depth and speed differ by.
    pub repeatability: Option<Figures>,
    /// Every variant that was trained, on the same presses.
    pub variants: BTreeMap<String, Figures>,
    /// How sure the twin is on the same presses, and whether it is right; `None` if too few presses taught to find out.
    #[serde(default)]
    pub certainty: Option<CertaintyScore>,
    /// Seed of the run.
    pub seed: u64,
}

pub(crate) fn baselines(evaluation: &Evaluation) -> BaselineFigures {
    BaselineFigures {
        zero: Figures::from(&evaluation.zero.overall),
        polynomial: evaluation
            .polynomial
            .as_ref()
            .map(|score| Figures::from(&score.overall)),
        kernel: evaluation
            .kernel
            .as_ref()
            .map(|score| Figures::from(&score.overall)),
    }
}

pub(crate) fn repeatability(found: Option<&Repeatability>) -> Option<Figures> {
    found.map(|repeatability| Figures::from(&repeatability.errors))
}

/// Names of taxels by their indices.
pub(crate) fn names(indices: BTreeSet<usize>, taxels: &[String]) -> Vec<String> {
    let name = |index: usize| taxels.get(index).cloned();
    indices.into_iter().filter_map(name).collect()
}
