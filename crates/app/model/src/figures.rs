//! Errors in the form that programs read.

use std::collections::{BTreeMap, BTreeSet};

use digitac::{Errors, Evaluation, Score};
use serde::{Deserialize, Serialize};

/// Errors in % of the largest reading of the file that they belong to. A mean without frames is
/// `None`: null in files.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// Mean absolute error of the nearest taxel while in contact.
    pub nearest_in_contact_percent: Option<f64>,
    /// Mean absolute error of all taxels in all frames.
    pub all_percent: Option<f64>,
    /// Mean absolute error of the presses' largest readings.
    pub peak_percent: Option<f64>,
    /// Number of frames of the headline figure.
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

/// The twin's errors, overall and in parts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwinFigures {
    /// Overall.
    #[serde(flatten)]
    pub overall: Figures,
    /// By file.
    pub by_file: BTreeMap<String, Figures>,
    /// By taxel.
    pub by_taxel: BTreeMap<String, Figures>,
    /// Number of frames deeper than the simulation reached. The last simulated state, continued
    /// linearly, stands for them; they are scored as well.
    pub frames_not_simulated: usize,
    /// Number of all frames.
    #[serde(default)]
    pub frames: usize,
}

impl TwinFigures {
    /// The figures of a score. `taxels` are the names of its taxels.
    #[must_use]
    pub fn new(score: &Score, taxels: &[String]) -> Self {
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

/// Errors of the baselines, on the same presses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BaselineFigures {
    /// Predicting zero.
    pub zero: Figures,
    /// Static polynomial of depth and location, fitted to the twin's training presses.
    pub polynomial: Option<Figures>,
    /// Parametric baseline: a power of depth times a function of distance, with the twin's model of
    /// the barometers, fitted to the same presses.
    pub kernel: Option<Figures>,
}

impl From<&Evaluation> for BaselineFigures {
    fn from(evaluation: &Evaluation) -> Self {
        let figures = |score: &Option<Score>| score.as_ref().map(|score| Figures::from(&score.overall));
        Self {
            zero: Figures::from(&evaluation.zero.overall),
            polynomial: figures(&evaluation.polynomial),
            kernel: figures(&evaluation.kernel),
        }
    }
}

/// Names of taxels by their indices.
#[must_use]
pub fn names(indices: BTreeSet<usize>, taxels: &[String]) -> Vec<String> {
    let name = |index: usize| taxels.get(index).cloned();
    indices.into_iter().filter_map(name).collect()
}
