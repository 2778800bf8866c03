//! The data of a page: results of a twin as they are.

use std::collections::BTreeSet;

use digitac::{BenchEstimate, CertaintyScore, Epoch, Evaluation, PairedPress, Repeatability, Score, Variant};
use twintac_depth_table::DepthTable;
use twintac_recording::Provenance;
use twintac_sensor::Sensor;

/// All data of the page of a twin.
#[derive(Clone, Debug)]
pub struct TwinReport<'a> {
    /// The sensor.
    pub sensor: &'a Sensor,
    /// Provenance of the sensor's readings.
    pub provenance: Provenance,
    /// Evaluation of the twin on held-out presses.
    pub evaluation: &'a Evaluation,
    /// The twin's uncertainty on these presses and its coverage, if the twin has an uncertainty.
    pub certainty: Option<&'a CertaintyScore>,
    /// Repeatability of the presses, if some repeat others.
    pub repeatability: Option<&'a Repeatability>,
    /// Indices of taxels that are left out of the headline.
    pub left_out: &'a BTreeSet<usize>,
    /// All presses, measured and simulated.
    pub presses: &'a [PairedPress],
    /// Indices of the held-out presses among them.
    pub test: &'a [usize],
    /// The twins that were compared.
    pub variants: Vec<TrainedVariant<'a>>,
    /// The calibration of the test setup.
    pub bench: &'a BenchEstimate,
    /// The simulated tables over depth.
    pub tables: &'a [DepthTable],
    /// How the page was made.
    pub making: Making,
}

/// One of the twins that were compared.
#[derive(Clone, Copy, Debug)]
pub struct TrainedVariant<'a> {
    /// Which model it is.
    pub variant: Variant,
    /// Whether it is the twin of this page.
    pub is_chosen: bool,
    /// Its errors on validation presses, by which the twin was chosen.
    pub validation: &'a Score,
    /// Its errors on test presses.
    pub test: &'a Score,
    /// Its losses by epoch.
    pub history: &'a [Epoch],
}

/// How a page was made.
#[derive(Clone, Debug, Default)]
pub struct Making {
    /// The command line.
    pub command: String,
    /// Source of the presses.
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
