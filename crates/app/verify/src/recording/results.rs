//! The results of the benchmark: `recording.json`.

use serde::{Deserialize, Serialize};

use super::faults::Outcome;
use super::kills::Kills;
use super::lab_bench::Summary;

/// All results.
#[derive(Serialize, Deserialize)]
pub(super) struct Results {
    pub(super) command: String,
    pub(super) provenance: String,
    /// A run without faults.
    pub(super) whole: Summary,
    pub(super) faults: Vec<Outcome>,
    pub(super) kills: Kills,
}
