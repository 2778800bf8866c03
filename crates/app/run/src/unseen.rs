//! A model judged on recordings from elsewhere.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use digitac::{
    Adaptation, Estimate, Evaluation, Model, ModelRecord, Places, Recalibration, Repeatability, Scale, Twin,
    adapt, evaluate, pair, recalibrate, repeatability,
};
use serde::Serialize;
use twintac_depth_table::{DepthTable, DepthTableSource};
use twintac_recording::{Press, Provenance, Recording};
use twintac_simulate::Gel;

use crate::depth_tables::DepthTableStore;
use crate::doubtful::left_out;
use crate::metrics::{self, BaselineFigures, Figures, TwinFigures, baselines, names};
use crate::model::gel_of;
use crate::press_checksum::press_checksum;
use crate::progress::Work;
use crate::{Progress, RunError};

/// Largest correction of an unseen file's contact height, mm.
const CONTACT_LIMIT_MM: f64 = 0.3;

/// A model's figures on recordings that it was not trained on.
#[derive(Clone, Debug, Serialize)]
pub struct UnseenEvaluation {
    /// Where the readings come from.
    pub provenance: Provenance,
    /// What the figures mean.
    pub definition: String,
    /// Taxels left out of the headline.
    pub taxels_left_out: Vec<String>,
    /// The variant.
    pub variant: String,
    /// Presses that were scored.
    pub presses: usize,
    /// Errors after each new file's contact height, or the adaptation, was fitted to its first presses, which are not scored.
    #[serde(flatten)]
    pub twin: TwinFigures,
    /// Errors on the same presses with contact heights as at training: what the twin says without having touched the gel once.
    pub uncalibrated: Figures,
    /// Predicting nothing, on the same presses.
    pub baselines: BaselineFigures,
    /// How well the presses themselves repeat.
    pub repeatability: Option<Figures>,
    /// Contact heights of files that the model had not seen; none if it was adapted.
    pub contact: Vec<Recalibration>,
    /// What was adapted to the sensor of the recordings, if that was asked for.
    pub adaptation: Option<Adaptation>,
}

/// Judges a model on other recordings of its sensor: simulates their places, fits each new file's contact height to its first presses,
/// and scores the rest. With `adapt_with` presses, gains and one contact height are fitted to the first ones instead: for another sensor of
/// the same description.
///
/// # Errors
/// A model that cannot be read, or that reads other taxels; too few presses to adapt with; presses that taught the model; a place that cannot be pressed.
pub fn evaluate_elsewhere(
    model_folder: &Path,
    recording: &Recording,
    adapt_with: Option<usize>,
    progress: &dyn Progress,
) -> Result<UnseenEvaluation, RunError> {
    let model = Model::load(model_folder)?;
    let record = &model.record;
    if recording.taxels != record.taxels {
        return Err(RunError::Input(format!(
            "the model reads taxels {:?}, the recordings have {:?}",
            record.taxels, recording.taxels
        )));
    }
    refuse_known(recording, record)?;
    let gel = gel_of(&model, model_folder)?;
    let left_out = left_out(gel.sensor());
    let (places, tables) = simulate(&gel, recording, &model, progress)?;
    let pressed = Pressed {
        recording,
        places: &places,
        tables: &tables,
        left_out: &left_out,
    };
    let adaptation = match adapt_with {
        Some(n_presses) => Some(pressed.adaptation(&model, n_presses)?),
        None => None,
    };
    let mut contact = Vec::new();
    let (twin, bench) = if let Some(adaptation) = &adaptation {
        adaptation.apply(&model.twin, &record.bench)
    } else {
        contact = pressed.contact_heights(&model)?;
        let mut bench = record.bench.clone();
        let heights = contact.iter();
        bench
            .contact_offset_mm
            .extend(heights.map(|found| (found.file.clone(), found.contact_offset_mm)));
        (model.twin.clone(), bench)
    };
    let used = contact.iter().map(|found| &found.used);
    let spent: BTreeSet<usize> = used
        .chain(adaptation.iter().map(|found| &found.used))
        .flatten()
        .copied()
        .collect();
    let (evaluation, repeats) = pressed.judge(&twin, &bench, &spent)?;
    let (uncalibrated, _) = pressed.judge(&model.twin, &record.bench, &spent)?;
    Ok(UnseenEvaluation {
        provenance: recording.provenance,
        definition: evaluation.twin.definition.clone(),
        taxels_left_out: names(left_out.clone(), &record.taxels),
        variant: record.variant.to_string(),
        presses: evaluation.presses.len(),
        twin: TwinFigures::new(&evaluation.twin, &record.taxels),
        uncalibrated: Figures::from(&uncalibrated.twin.overall),
        baselines: baselines(&evaluation),
        repeatability: metrics::repeatability(repeats.as_ref()),
        contact,
        adaptation,
    })
}

/// Presses that taught a model are not unseen.
fn refuse_known(recording: &Recording, record: &ModelRecord) -> Result<(), RunError> {
    let known: Vec<&Press> = recording
        .presses
        .iter()
        .filter(|press| record.taught_by.contains(&press_checksum(press)))
        .collect();
    let Some(first) = known.first() else {
        return Ok(());
    };
    Err(RunError::Input(format!(
        "{} of {} presses taught this model, `{}` of {} for one; give recordings that it has never seen",
        known.len(),
        recording.presses.len(),
        first.name,
        first.mounting
    )))
}

/// A table over depth for each place that a recording presses.
fn simulate(
    gel: &Gel,
    recording: &Recording,
    model: &Model,
    progress: &dyn Progress,
) -> Result<(Places, Vec<DepthTable>), RunError> {
    let folder = tempfile::tempdir().map_err(RunError::file(
        "making",
        Path::new("a temporary folder for simulations"),
    ))?;
    let _work = Work::start(progress, "simulating", 0);
    let store = DepthTableStore::new(gel, folder.path().to_owned(), progress);
    let places = Places::of(recording, &store, &digitac::PlaceSettings::default())?;
    let places = places.at_bench(&model.record.bench);
    let tables = store.depth_tables(&places.requests)?;
    Ok((places, tables))
}

/// A recording beside what the gel does at its places.
struct Pressed<'a> {
    recording: &'a Recording,
    places: &'a Places,
    tables: &'a [DepthTable],
    left_out: &'a BTreeSet<usize>,
}

impl Pressed<'_> {
    /// The contact heights of files that the model had not seen.
    fn contact_heights(&self, model: &Model) -> Result<Vec<Recalibration>, RunError> {
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

    /// What the first presses say of gains and contact height.
    fn adaptation(&self, model: &Model, n_presses: usize) -> Result<Adaptation, RunError> {
        let found = adapt(
            self.recording,
            (self.places, self.tables),
            &model.record.bench,
            &model.twin,
            n_presses,
            CONTACT_LIMIT_MM,
            self.left_out,
        )?;
        found.ok_or_else(|| {
            RunError::Input(format!(
                "{n_presses} presses to adapt with and some to judge are needed; the recordings have {} presses, those with a prescribed \
                 force do not count",
                self.recording.presses.len()
            ))
        })
    }

    /// The errors of presses that are not spent, on a bench.
    fn judge(
        &self,
        twin: &Twin,
        bench: &digitac::BenchEstimate,
        spent: &BTreeSet<usize>,
    ) -> Result<(Evaluation, Option<Repeatability>), RunError> {
        let settings = digitac::PairSettings::default();
        let presses = pair(self.recording, self.places, self.tables, bench, &settings)?;
        let scale = Scale::of(&presses, self.left_out.clone());
        let scored: Vec<usize> = (0..presses.len())
            .filter(|index| !spent.contains(index))
            .collect();
        Ok((
            evaluate(twin, &presses, &scored, &scale, None),
            repeatability(&presses, &scale),
        ))
    }
}

fn new_files(recording: &Recording, known: &BTreeMap<String, Estimate>) -> BTreeSet<String> {
    let files = recording.presses.iter().map(|press| press.mounting.clone());
    files.filter(|file| !known.contains_key(file)).collect()
}
