//! A model's folder made from another sensor's model and a few presses.

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

/// What to adapt a model with.
#[derive(Clone, Debug)]
pub struct AdaptationPlan<'a> {
    /// The folder of the model to start from.
    pub model: &'a Path,
    /// The new sensor, where it is not as the model's description says.
    pub sensor: Option<&'a SensorFile>,
    /// Presses of the new sensor.
    pub recording: &'a Recording,
    /// How many of them to adapt with; the rest judge.
    pub presses: usize,
    /// Seed of what choosing them leaves to chance.
    pub seed: u64,
    /// The folder to write to.
    pub out: &'a Path,
}

/// What was adapted, and how well it does.
#[derive(Clone, Debug, Serialize)]
pub struct AdaptedModel {
    /// Where the new sensor's readings come from.
    pub provenance: Provenance,
    /// Where those come from that the model was trained with.
    pub trained_on: Provenance,
    /// The folder of the adapted model.
    pub model: PathBuf,
    /// Names of the taxels, in the order of the adaptation's values.
    pub taxels: Vec<String>,
    /// Taxels left out of the headline.
    pub taxels_left_out: Vec<String>,
    /// Which model it is.
    pub variant: String,
    /// Names of the presses that were adapted with, in the order in which they were chosen.
    pub adapted_with: Vec<String>,
    /// What was adapted, and how sure it is.
    pub adaptation: Adaptation,
    /// Gains as they were learned on the other sensor; `[n_taxels]`.
    pub learned_gain: Vec<f64>,
    /// How many presses judged: those that were not adapted with.
    pub judged_presses: usize,
    /// Errors on these; `None` if there were none.
    pub twin: Option<TwinFigures>,
    /// Errors on the same presses of the twin as it was learned.
    pub as_learned: Option<Figures>,
    /// What the figures mean.
    pub definition: String,
}

/// Adapts a model to another sensor. Leaves its folder in `model` of the plan's folder, and what was found in `adaptation.json`; `depth_tables` has
/// what was simulated.
///
/// # Errors
/// A model that cannot be read, that reads other taxels, that has no gains, or that some of the presses taught; a place that cannot be pressed;
/// a file that cannot be written.
pub fn adapt_model(plan: &AdaptationPlan<'_>, caller: &Caller) -> Result<AdaptedModel, WorkError> {
    let model = Model::load(plan.model)?;
    let (recording, record) = (plan.recording, &model.record);
    let gel = NewGel::open((&model, plan.model), plan.sensor, recording, plan.out, caller)?;
    let all: Vec<usize> = (0..recording.presses.len()).collect();
    let used = gel.choose(&all, plan.presses, plan.seed)?;
    let adapted = gel.adapt(&used)?;
    let rest: Vec<usize> = all.into_iter().filter(|press| !used.contains(press)).collect();
    let taught = gel.judge(&adapted, &used)?;
    let judged = (!rest.is_empty())
        .then(|| gel.judge(&adapted, &rest))
        .transpose()?;
    let as_learned = (!rest.is_empty())
        .then(|| gel.judge_as_learned(&rest))
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
        taught_by: used
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
    let definition = taught.twin.definition.clone();
    Model::new(adapted.twin.clone(), origin, taught.twin, judged.as_ref()).save(&folder)?;
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
        judged_presses: rest.len(),
        twin: judged.map(|judged| TwinFigures::new(&judged.twin, &record.taxels)),
        as_learned: as_learned.map(|judged| Figures::from(&judged.twin.overall)),
        definition,
    };
    write_json(&plan.out.join("adaptation.json"), &found)?;
    Ok(found)
}
