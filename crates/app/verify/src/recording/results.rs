//! What is found, as `recording.json` has it.

use serde::{Deserialize, Serialize};

use super::faults::Outcome;
use super::kills::Kills;
use super::lab_bench::Summary;

/// All that was found.
#[derive(Serialize, Deserialize)]
pub(super) struct Results {
    pub(super) command: String,
    pub(super) provenance: String,
    /// A run in which nothing goes wrong.
    pub(super) whole: Summary,
    pub(super) faults: Vec<Outcome>,
    pub(super) kills: Kills,
}
