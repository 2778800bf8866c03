//! `metrics.json`: the figures of a run, for programs.

use std::collections::BTreeMap;

use digitac::{Errors, Evaluation, Repeatability, Score};
use serde::{Deserialize, Serialize};
use twintac_recording::Provenance;

/// Errors in % of the largest reading of the file that they belong to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Figures {
    /// Mean absolute error of the nearest taxel while in contact.
    pub(crate) nearest_in_contact_percent: f64,
    /// Mean absolute error of all taxels in all frames.
    pub(crate) all_percent: f64,
    /// Mean absolute error of the presses' largest readings.
    pub(crate) peak_percent: f64,
    /// Frames behind the headline.
    pub(crate) frames_in_contact: usize,
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
pub(crate) struct TwinFigures {
    /// Overall.
    #[serde(flatten)]
    pub(crate) overall: Figures,
    /// By file.
    pub(crate) by_file: BTreeMap<String, Figures>,
    /// By taxel.
    pub(crate) by_taxel: BTreeMap<String, Figures>,
    /// Frames deeper than the simulation reached; they are scored all the same.
    pub(crate) frames_not_simulated: usize,
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
        }
    }
}

/// What the twin is compared with, on the same presses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct BaselineFigures {
    /// Nothing is ever felt.
    pub(crate) zero: Figures,
    /// A polynomial of depth and place, fitted to the twin's training presses.
    pub(crate) polynomial: Option<Figures>,
}

/// All figures of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Metrics {
    /// The sensor's name.
    pub(crate) sensor: String,
    /// Where the readings come from.
    pub(crate) provenance: Provenance,
    /// What the figures mean.
    pub(crate) definition: String,
    /// Taxels left out of the headline.
    pub(crate) taxels_left_out: Vec<String>,
    /// The variant behind the headline.
    pub(crate) variant: String,
    /// Presses that the twin never saw.
    pub(crate) held_out_presses: usize,
    /// The twin's errors on them.
    pub(crate) twin: TwinFigures,
    /// The same with no taxel left out, if some were.
    pub(crate) twin_all_taxels: Option<Figures>,
    /// What to beat.
    pub(crate) baselines: BaselineFigures,
    /// What no twin can beat.
    pub(crate) repeatability: Option<Figures>,
    /// Every variant that was trained, on the same presses.
    pub(crate) variants: BTreeMap<String, Figures>,
    /// Seed of the run.
    pub(crate) seed: u64,
}

pub(crate) fn baselines(evaluation: &Evaluation) -> BaselineFigures {
    BaselineFigures {
        zero: Figures::from(&evaluation.zero.overall),
        polynomial: evaluation
            .polynomial
            .as_ref()
            .map(|score| Figures::from(&score.overall)),
    }
}

pub(crate) fn repeatability(found: Option<&Repeatability>) -> Option<Figures> {
    found.map(|repeatability| Figures::from(&repeatability.errors))
}
