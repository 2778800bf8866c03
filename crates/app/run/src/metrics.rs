//! `metrics.json`: the figures of a run, for programs.

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
