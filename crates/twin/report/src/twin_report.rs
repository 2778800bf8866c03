//! What a page shows: results of the twin, as they are.

use std::collections::BTreeSet;

use digitac::{BenchEstimate, CertaintyScore, Epoch, Evaluation, PairedPress, Repeatability, Score, Variant};
use twintac_depth_table::DepthTable;
use twintac_recording::Provenance;
use twintac_sensor::Sensor;

/// All that stands on the page of a twin.
#[derive(Clone, Debug)]
pub struct TwinReport<'a> {
    /// The sensor.
    pub sensor: &'a Sensor,
    /// Where the sensor's readings come from.
    pub provenance: Provenance,
    /// The twin on presses that it never saw.
    pub evaluation: &'a Evaluation,
    /// How sure the twin is on them, and whether it is right, if it knows.
    pub certainty: Option<&'a CertaintyScore>,
    /// How well the presses themselves repeat, if some repeat others.
    pub repeatability: Option<&'a Repeatability>,
    /// Taxels left out of the headline, by index.
    pub left_out: &'a BTreeSet<usize>,
    /// All presses, measured and simulated.
    pub presses: &'a [PairedPress],
    /// Which of them the twin never saw.
    pub test: &'a [usize],
    /// The twins that were compared.
    pub variants: Vec<TrainedVariant<'a>>,
    /// What was found about the bench.
    pub bench: &'a BenchEstimate,
    /// The simulated tables.
    pub tables: &'a [DepthTable],
    /// How the page came to be.
    pub making: Making,
}

/// One of the twins that were compared.
#[derive(Clone, Copy, Debug)]
pub struct TrainedVariant<'a> {
    /// Which model it is.
    pub variant: Variant,
    /// Whether it is the twin of this page.
    pub is_chosen: bool,
    /// Its errors on validation presses, by which the choice was made.
    pub validation: &'a Score,
    /// Its errors on test presses.
    pub test: &'a Score,
    /// Its losses.
    pub history: &'a [Epoch],
}

/// How a page came to be.
#[derive(Clone, Debug, Default)]
pub struct Making {
    /// The command line.
    pub command: String,
    /// Where the presses come from.
    pub source: String,
    /// The seed of all random streams.
    pub seed: u64,
    /// Settings used, as text.
    pub settings: String,
    /// Stages in the order in which they ran.
    pub stages: Vec<StageTime>,
}

/// Time spent in a stage.
#[derive(Clone, Debug)]
pub struct StageTime {
    /// The stage's name.
    pub name: String,
    /// Wall time, s.
    pub wall_s: f64,
}
