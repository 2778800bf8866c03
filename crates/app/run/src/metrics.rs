//! The figures of a run for programs: `metrics.json`.

use std::collections::BTreeMap;

use digitac::CertaintyScore;
use serde::{Deserialize, Serialize};
use twintac_model::{BaselineFigures, Figures, TwinFigures};
use twintac_recording::Provenance;

/// All figures of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Metrics {
    /// The sensor's name.
    pub sensor: String,
    /// Provenance of the readings.
    pub provenance: Provenance,
    /// What the figures mean.
    pub definition: String,
    /// Taxels excluded from the headline figure.
    pub taxels_left_out: Vec<String>,
    /// The variant that the validation presses chose.
    pub variant: String,
    /// Number of test presses, on which the twin was not trained.
    pub held_out_presses: usize,
    /// The twin's errors on the test presses.
    pub twin: TwinFigures,
    /// The errors with all taxels, if some were excluded.
    pub twin_all_taxels: Option<Figures>,
    /// Errors of the baselines on the same presses.
    pub baselines: BaselineFigures,
    /// Repeatability: the difference between two presses of the same location, depth and speed.
    pub repeatability: Option<Figures>,
    /// Errors of every trained variant on the same presses.
    pub variants: BTreeMap<String, Figures>,
    /// Prediction intervals and OOD score of the twin, evaluated on the same presses; `None` if
    /// there were too few training presses.
    #[serde(default)]
    pub certainty: Option<CertaintyScore>,
    /// Seed of the run.
    pub seed: u64,
}
