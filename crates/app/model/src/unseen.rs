//! Evaluation of a model on other recordings.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use digitac::{
    BenchEstimate, Estimate, Evaluation, Model, ModelRecord, Places, Recalibration, Repeatability, Scale,
    Twin, evaluate, pair, recalibrate, repeatability,
};
use serde::Serialize;
use twintac_depth_table::{DepthTable, DepthTableSource};
use twintac_recording::{Press, Provenance, Recording};
use twintac_sensor::Sensor;
use twintac_tables::DepthTableStore;
use twintac_work::{Progress, Work, WorkError};

use crate::figures::{BaselineFigures, Figures, TwinFigures, names};
use crate::gel::gel_of;
use crate::press_checksum::press_checksum;
use crate::taxels::left_out;
use crate::temperature::as_in_training;

/// Largest correction of an unseen file's contact height, mm.
const CONTACT_LIMIT_MM: f64 = 0.3;

/// A model's figures on recordings that it was not trained on.
#[derive(Clone, Debug, Serialize)]
pub struct UnseenEvaluation {
    /// Provenance of the readings.
    pub provenance: Provenance,
    /// What the figures mean.
    pub definition: String,
    /// Taxels excluded from the headline figure.
    pub taxels_left_out: Vec<String>,
    /// The variant of the twin.
    pub variant: String,
    /// Number of presses that were scored.
    pub presses: usize,
    /// Errors after each new file's contact height was fitted to its first presses, which are not
    /// scored.
    #[serde(flatten)]
    pub twin: TwinFigures,
    /// Errors on the same presses with the contact heights of the training: the prediction without
    /// a single touch of the new gel.
    pub uncalibrated: Figures,
    /// Predicting zero, on the same presses.
    pub baselines: BaselineFigures,
    /// Repeatability of the presses themselves.
    pub repeatability: Option<Figures>,
    /// Fitted contact heights of files that the model had not seen.
    pub contact: Vec<Recalibration>,
}

/// Evaluates a model on other recordings of its sensor: simulates their locations, fits each new
/// file's contact height to its first presses, and scores the rest.
///
/// # Errors
/// A model that cannot be read; recordings of another sensor; presses that the
/// model was trained on; a location that cannot be pressed.
pub fn evaluate_elsewhere(
    model_folder: &Path,
    recording: &Recording,
    progress: &dyn Progress,
) -> Result<UnseenEvaluation, WorkError> {
    let model = Model::load(model_folder)?;
    let record = &model.record;
    let gel = gel_of(&model, model_folder)?;
    refuse_other_sensor(recording, gel.sensor())?;
    refuse_known(recording, record)?;
    let recording = &*as_in_training(recording, record, progress)?;
    let left_out = left_out(gel.sensor());
    let store = DepthTableStore::of(gel.clone(), progress)?;
    let (places, tables) = simulate(&store, recording, &record.bench, progress)?;
    let pressed = Pressed {
        recording,
        places: &places,
        tables: &tables,
        left_out: &left_out,
    };
    let contact = pressed.contact_heights(&model)?;
    let mut bench = record.bench.clone();
    let heights = contact.iter();
    bench
        .contact_offset_mm
        .extend(heights.map(|found| (found.file.clone(), found.contact_offset_mm)));
    let used = contact.iter().flat_map(|found| &found.used);
    let spent: BTreeSet<usize> = used.copied().collect();
    let scored: Vec<usize> = (0..recording.presses.len())
        .filter(|index| !spent.contains(index))
        .collect();
    let (evaluation, repeats) = pressed.evaluate(&model.twin, &bench, &scored)?;
    let (uncalibrated, _) = pressed.evaluate(&model.twin, &record.bench, &scored)?;
    Ok(UnseenEvaluation {
        provenance: recording.provenance,
        definition: evaluation.twin.definition.clone(),
        taxels_left_out: names(left_out.clone(), &record.taxels),
        variant: record.variant.to_string(),
        presses: evaluation.presses.len(),
        twin: TwinFigures::new(&evaluation.twin, &record.taxels),
        uncalibrated: Figures::from(&uncalibrated.twin.overall),
        baselines: BaselineFigures::from(&evaluation),
        repeatability: repeats.as_ref().map(|found| Figures::from(&found.errors)),
        contact,
    })
}

/// Refuses recordings of another sensor, by name and by taxels: sensors whose taxels have the same
/// names may have other gels. Recordings without presses are refused as well.
pub(crate) fn refuse_other_sensor(recording: &Recording, sensor: &Sensor) -> Result<(), WorkError> {
    if recording.presses.is_empty() {
        return Err(WorkError::Input(format!(
            "the recordings of `{}` have no presses: give other recordings",
            recording.sensor
        )));
    }
    if recording.sensor != sensor.name {
        return Err(WorkError::Input(format!(
            "the recordings are of the sensor `{}`, not of `{}`; if the sensor has another name there, give --recorded-as {}",
            recording.sensor, sensor.name, recording.sensor
        )));
    }
    let taxels = sensor.taxels.iter().map(|taxel| &taxel.name);
    if recording.taxels.iter().eq(taxels.clone()) {
        return Ok(());
    }
    Err(WorkError::Input(format!(
        "the sensor `{}` has taxels {:?}, the recordings have {:?}",
        sensor.name,
        taxels.collect::<Vec<_>>(),
        recording.taxels
    )))
}

/// Refuses presses that a model was trained on.
pub(crate) fn refuse_known(recording: &Recording, record: &ModelRecord) -> Result<(), WorkError> {
    let known: Vec<&Press> = recording
        .presses
        .iter()
        .filter(|press| record.trained_on.contains(&press_checksum(press)))
        .collect();
    let Some(first) = known.first() else {
        return Ok(());
    };
    Err(WorkError::Input(format!(
        "this model was trained on {} of {} presses, for example `{}` of {}; give other recordings",
        known.len(),
        recording.presses.len(),
        first.name,
        first.mounting
    )))
}

/// A table over depth for each location that a recording presses.
pub(crate) fn simulate(
    store: &DepthTableStore<'_>,
    recording: &Recording,
    bench: &BenchEstimate,
    progress: &dyn Progress,
) -> Result<(Places, Vec<DepthTable>), WorkError> {
    let _work = Work::start(progress, "simulating", 0);
    let places = Places::of(recording, store, &digitac::PlaceSettings::default())?.at_bench(bench);
    let tables = store.depth_tables(&places.requests)?;
    Ok((places, tables))
}

/// A recording, with the simulated response of the gel at its locations.
pub(crate) struct Pressed<'a> {
    pub recording: &'a Recording,
    pub places: &'a Places,
    pub tables: &'a [DepthTable],
    pub left_out: &'a BTreeSet<usize>,
}

impl Pressed<'_> {
    /// Fits the contact heights of files that the model had not seen.
    fn contact_heights(&self, model: &Model) -> Result<Vec<Recalibration>, WorkError> {
        let bench = &model.record.bench;
        let mut contact = Vec::new();
        for file in new_files(self.recording, &bench.contact_offset_mm) {
            contact.extend(recalibrate(
                self.recording,
                (self.places, self.tables),
                bench,
                &model.twin,
                &file,
                CONTACT_LIMIT_MM,
                self.left_out,
            )?);
        }
        Ok(contact)
    }

    /// The errors of some presses, on a bench.
    pub(crate) fn evaluate(
        &self,
        twin: &Twin,
        bench: &BenchEstimate,
        scored: &[usize],
    ) -> Result<(Evaluation, Option<Repeatability>), WorkError> {
        let settings = digitac::PairSettings::default();
        let presses = pair(self.recording, self.places, self.tables, bench, &settings)?;
        let scale = Scale::of(&presses, self.left_out.clone());
        Ok((
            evaluate(twin, &presses, scored, &scale, None),
            repeatability(&presses, &scale),
        ))
    }
}

fn new_files(recording: &Recording, known: &BTreeMap<String, Estimate>) -> BTreeSet<String> {
    let files = recording.presses.iter().map(|press| press.mounting.clone());
    files.filter(|file| !known.contains_key(file)).collect()
}
