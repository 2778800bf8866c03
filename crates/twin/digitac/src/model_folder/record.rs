//! A twin with all that is needed to use it, and to know where it comes from.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use twintac_recording::Provenance;
use twintac_temperature::Compensation;

use crate::network::Normalization;
use crate::{BenchEstimate, Certainty, Evaluation, Gains, Score, Split, TrainedWith, Twin, Variant};

/// A twin and its record.
#[derive(Clone, Debug)]
pub struct Model {
    /// Where it comes from.
    pub record: ModelRecord,
    /// The twin itself.
    pub twin: Twin,
    /// The surfaces (STL) that the sensor description names: names relative to the model's folder, and contents.
    pub surfaces: BTreeMap<String, Arc<[u8]>>,
}

/// Everything about a twin but its weights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelRecord {
    /// Which model it is.
    pub variant: Variant,
    /// Names of the taxels, in the order of every row of readings.
    pub taxels: Vec<String>,
    /// The sensor description, as text.
    pub sensor: String,
    /// Settings of the mesh and the simulation.
    pub simulation: serde_json::Value,
    /// What was found about the bench.
    pub bench: BenchEstimate,
    /// Gains and memory as learned.
    pub gains: Gains,
    /// Settings of the training.
    pub settings: TrainedWith,
    /// Where the training data come from.
    pub provenance: Provenance,
    /// Files that the training presses were read from.
    pub files: Vec<String>,
    /// Checksums of the presses that taught: what is judged elsewhere must not be among them.
    #[serde(default)]
    pub taught_by: BTreeSet<String>,
    /// How zeros move with temperature: readings that taught were compensated for it, as far as they had temperatures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<Compensation>,
    /// Which presses were used for training, validation and test.
    pub split: Split,
    /// Errors on validation presses; of an adapted twin, on those that it was adapted with.
    pub validation: Score,
    /// Errors on test presses at training; of an adapted twin, on those that it was not adapted with.
    pub test: Option<Score>,
    /// How sure it is of its readings; `None` of models that were made before this was found, and of adapted ones.
    #[serde(default)]
    pub certainty: Option<Certainty>,
    /// The initial values that the weights are stored relative to; needed to read them.
    pub(crate) start: Start,
}

/// The initial values that the weights are stored relative to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Start {
    pub(crate) gains: Gains,
    pub(crate) normalization: Normalization,
    pub(crate) correction_limit: f64,
    pub(crate) hidden: Vec<usize>,
}

/// Where a model comes from: what [`Model::new`] cannot derive from the twin.
#[derive(Clone, Debug, PartialEq)]
pub struct Origin {
    /// The sensor description, as text.
    pub sensor: String,
    /// The surfaces (STL) that it names: names relative to the model's folder, and contents.
    pub surfaces: BTreeMap<String, Arc<[u8]>>,
    /// Settings of the mesh and the simulation.
    pub simulation: serde_json::Value,
    /// What was found about the bench.
    pub bench: BenchEstimate,
    /// Settings of the training.
    pub settings: TrainedWith,
    /// Where the training data come from.
    pub provenance: Provenance,
    /// Files that the training presses were read from.
    pub files: Vec<String>,
    /// Checksums of the presses that taught.
    pub taught_by: BTreeSet<String>,
    /// How zeros move with temperature, if it is known.
    pub temperature: Option<Compensation>,
    /// Which presses were used for training, validation and test.
    pub split: Split,
    /// How sure the twin is of its readings, if it is known.
    pub certainty: Option<Certainty>,
}

impl Model {
    /// Joins a trained twin and its record.
    #[must_use]
    pub fn new(twin: Twin, origin: Origin, validation: Score, test: Option<&Evaluation>) -> Self {
        let physics = twin.physics();
        let record = ModelRecord {
            variant: twin.variant(),
            taxels: twin.taxels().to_vec(),
            sensor: origin.sensor,
            simulation: origin.simulation,
            bench: origin.bench,
            gains: twin.gains().clone(),
            settings: origin.settings,
            provenance: origin.provenance,
            files: origin.files,
            taught_by: origin.taught_by,
            temperature: origin.temperature,
            split: origin.split,
            validation,
            certainty: origin.certainty,
            test: test.map(|evaluation| evaluation.twin.clone()),
            start: Start {
                gains: physics.gains.clone(),
                normalization: physics.normalization.clone(),
                correction_limit: physics.correction_limit,
                hidden: twin.parameters().hidden(),
            },
        };
        Self {
            record,
            twin,
            surfaces: origin.surfaces,
        }
    }
}
