//! Adapts a model to another sensor with a few presses, and saves it in a new folder.

use std::path::{Path, PathBuf};

use digitac::{Adaptation, Model, Origin, Split};
use serde::Serialize;
use twintac_recording::{Provenance, Recording};
use twintac_sensor::SensorFile;
use twintac_store::write_json;
use twintac_work::{Caller, WorkError};

use crate::figures::{Figures, TwinFigures, names};
use crate::new_gel::NewGel;
use crate::press_checksum::press_checksum;

/// The inputs of an adaptation.
#[derive(Clone, Debug)]
pub struct AdaptationPlan<'a> {
    /// The folder of the model to start from.
    pub model: &'a Path,
    /// The new sensor, if it differs from the model's description.
    pub sensor: Option<&'a SensorFile>,
    /// Presses of the new sensor.
    pub recording: &'a Recording,
    /// Number of presses to adapt with. The rest are test presses.
    pub presses: usize,
    /// Seed of the random part of their choice.
    pub seed: u64,
    /// The folder to write to.
    pub out: &'a Path,
}

/// The result of an adaptation, with its errors: `adaptation.json`.
#[derive(Clone, Debug, Serialize)]
pub struct AdaptedModel {
    /// Provenance of the new sensor's readings.
    pub provenance: Provenance,
    /// Provenance of the readings that the original model was trained on.
    pub trained_on: Provenance,
    /// The folder of the adapted model.
    pub model: PathBuf,
    /// Names of the taxels, in the order of the adaptation's values.
    pub taxels: Vec<String>,
    /// Taxels excluded from the headline figure.
    pub taxels_left_out: Vec<String>,
    /// The variant of the model.
    pub variant: String,
    /// Names of the presses that were used, in the order in which they were chosen.
    pub adapted_with: Vec<String>,
    /// The adapted values, and their uncertainties.
    pub adaptation: Adaptation,
    /// Gains of the original model; `[n_taxels]`.
    pub learned_gain: Vec<f64>,
    /// Number of test presses: those that were not used to adapt.
    pub evaluated_presses: usize,
    /// Errors on the test presses; `None` if there were none.
    pub twin: Option<TwinFigures>,
    /// Errors of the original twin on the same presses.
    pub as_learned: Option<Figures>,
    /// What the figures mean.
    pub definition: String,
}

/// Adapts a model to another sensor. The plan's folder gets the adapted model in `model`, the
/// result in `adaptation.json`, and the simulated tables in `depth_tables`.
///
/// # Errors
/// A model that cannot be read, that reads other taxels, that has no gains, or that was trained on
/// some of the presses; a location that cannot be pressed; a file that cannot be written.
pub fn adapt_model(plan: &AdaptationPlan<'_>, caller: &Caller) -> Result<AdaptedModel, WorkError> {
    let model = Model::load(plan.model)?;
    let (recording, record) = (plan.recording, &model.record);
    let gel = NewGel::open((&model, plan.model), plan.sensor, recording, plan.out, caller)?;
    let all: Vec<usize> = (0..recording.presses.len()).collect();
    let used = gel.choose(&all, plan.presses, plan.seed)?;
    let adapted = gel.adapt(&used)?;
    let rest: Vec<usize> = all.into_iter().filter(|press| !used.contains(press)).collect();
    let on_used = gel.evaluate(&adapted, &used)?;
    let evaluation = (!rest.is_empty())
        .then(|| gel.evaluate(&adapted, &rest))
        .transpose()?;
    let as_learned = (!rest.is_empty())
        .then(|| gel.evaluate_as_learned(&rest))
        .transpose()?;
    let folder = plan.out.join("model");
    let (sensor, surfaces) = match plan.sensor {
        Some(sensor) => {
            let kept = sensor.kept_as(&folder.join("twin.json"))?;
            (kept.text.clone(), kept.surfaces().clone())
        }
        None => (record.sensor.clone(), model.surfaces.clone()),
    };
    let origin = Origin {
        sensor,
        surfaces,
        simulation: record.simulation.clone(),
        bench: adapted.bench.clone(),
        settings: record.settings.clone(),
        provenance: recording.provenance,
        files: adapted.bench.contact_offset_mm.keys().cloned().collect(),
        trained_on: used
            .iter()
            .map(|&press| press_checksum(&recording.presses[press]))
            .collect(),
        split: Split {
            train: used.clone(),
            validation: Vec::new(),
            test: rest.clone(),
        },
        certainty: None,
        temperature: None,
    };
    let definition = on_used.twin.definition.clone();
    Model::new(adapted.twin.clone(), origin, on_used.twin, evaluation.as_ref()).save(&folder)?;
    let found = AdaptedModel {
        provenance: recording.provenance,
        trained_on: record.provenance,
        model: folder,
        taxels: record.taxels.clone(),
        taxels_left_out: names(gel.left_out.clone(), &record.taxels),
        variant: adapted.twin.variant().to_string(),
        adapted_with: used
            .iter()
            .map(|&press| recording.presses[press].name.clone())
            .collect(),
        adaptation: adapted.adaptation,
        learned_gain: model.twin.gains().gain.clone(),
        evaluated_presses: rest.len(),
        twin: evaluation.map(|evaluation| TwinFigures::new(&evaluation.twin, &record.taxels)),
        as_learned: as_learned.map(|evaluation| Figures::from(&evaluation.twin.overall)),
        definition,
    };
    write_json(&plan.out.join("adaptation.json"), &found)?;
    Ok(found)
}
