//! A twin with everything that is needed to use it and to know its origin.

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
    /// The record: origin, settings and errors.
    pub record: ModelRecord,
    /// The twin itself.
    pub twin: Twin,
    /// The surfaces (STL) that the sensor description names: names relative to the model's folder,
    /// and contents.
    pub surfaces: BTreeMap<String, Arc<[u8]>>,
}

/// Everything about a twin except its weights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelRecord {
    /// The variant of the model.
    pub variant: Variant,
    /// Names of the taxels, in the order of every row of readings.
    pub taxels: Vec<String>,
    /// The sensor description, as text.
    pub sensor: String,
    /// Settings of the mesh and of the simulation.
    pub simulation: serde_json::Value,
    /// Estimate of the test setup.
    pub bench: BenchEstimate,
    /// Learned gains and relaxation.
    pub gains: Gains,
    /// Settings of the training.
    pub settings: TrainedWith,
    /// Provenance of the training data.
    pub provenance: Provenance,
    /// Files from which the training presses were read.
    pub files: Vec<String>,
    /// Checksums of the training presses. Presses of another evaluation must not be among them.
    #[serde(default, alias = "taught_by")]
    pub trained_on: BTreeSet<String>,
    /// Compensation of the zeros for temperature. The training readings were compensated, as far as
    /// they had temperatures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<Compensation>,
    /// The presses used for training, validation and test.
    pub split: Split,
    /// Errors on validation presses; for an adapted twin, on the presses that it was adapted with.
    pub validation: Score,
    /// Errors on test presses at the time of training; for an adapted twin, on presses that it was
    /// not adapted with.
    pub test: Option<Score>,
    /// Intervals and OOD score; `None` for models of earlier versions without them, and for adapted
    /// models.
    #[serde(default)]
    pub certainty: Option<Certainty>,
    /// The initial values that the stored weights are relative to; needed to read them.
    pub(crate) start: Start,
}

/// The initial values that the stored weights are relative to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Start {
    pub(crate) gains: Gains,
    pub(crate) normalization: Normalization,
    pub(crate) correction_limit: f64,
    pub(crate) hidden: Vec<usize>,
}

/// Origin of a model: what [`Model::new`] cannot derive from the twin.
#[derive(Clone, Debug, PartialEq)]
pub struct Origin {
    /// The sensor description, as text.
    pub sensor: String,
    /// The surfaces (STL) that it names: names relative to the model's folder, and contents.
    pub surfaces: BTreeMap<String, Arc<[u8]>>,
    /// Settings of the mesh and of the simulation.
    pub simulation: serde_json::Value,
    /// Estimate of the test setup.
    pub bench: BenchEstimate,
    /// Settings of the training.
    pub settings: TrainedWith,
    /// Provenance of the training data.
    pub provenance: Provenance,
    /// Files from which the training presses were read.
    pub files: Vec<String>,
    /// Checksums of the training presses.
    pub trained_on: BTreeSet<String>,
    /// Compensation of the zeros for temperature, if it is known.
    pub temperature: Option<Compensation>,
    /// The presses used for training, validation and test.
    pub split: Split,
    /// Intervals and OOD score of the twin, if they are known.
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
            trained_on: origin.trained_on,
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
