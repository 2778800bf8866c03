//! Stage `evaluation`, and the evaluation of a model on recordings from elsewhere.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result, bail};
use digitac::{
    Estimate, Evaluation, Model, Places, Recalibration, Repeatability, Scale, StaticPolynomial, evaluate,
    pair, recalibrate, repeatability,
};
use serde::{Deserialize, Serialize};
use twintac_depth_table::DepthTableSource;
use twintac_recording::{Provenance, Recording};
use twintac_simulate::{Gel, SimulateSettings};

use crate::cache::{Inputs, read_json, write_json};
use crate::depth_tables::DepthTableStore;
use crate::metrics::{BaselineFigures, Figures, Metrics, TwinFigures, baselines};
use crate::progress;
use crate::run::{Run, left_out};
use crate::sensor_file::parse_sensor;

/// Largest correction of an unseen file's contact height, mm.
const CONTACT_LIMIT_MM: f64 = 0.3;

/// What the evaluation stage left: `evaluation.json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct HeldOut {
    /// The twin on presses that it never saw.
    pub evaluation: Evaluation,
    /// How well the presses themselves repeat.
    pub repeatability: Option<Repeatability>,
}

impl Run {
    /// Judges the held-out twin.
    pub fn evaluate(&self) -> Result<()> {
        let inputs = Inputs::new()?
            .file(&self.folder.join("sensor.toml"))?
            .stage(&self.stage("simulation"))?
            .stage(&self.stage("pairs"))?
            .stage(&self.stage("training"))?;
        self.run_stage("evaluation", inputs, |folder| {
            let presses = self.pairs()?;
            let model = Model::load(&self.stage("training").join("held-out"))?;
            let split = &model.record.split;
            let test: Vec<_> = split.test.iter().map(|&index| &presses[index]).collect();
            let teaching: Vec<_> = split.train.iter().map(|&index| &presses[index]).collect();
            let polynomial = StaticPolynomial::fit(&teaching);
            let scale = Scale::of(&presses, self.left_out());
            let evaluation = evaluate(&model.twin, &test, &scale, Some(&polynomial));
            let every_taxel = (!self.left_out().is_empty()).then(|| {
                let scale = Scale::of(&presses, BTreeSet::new());
                Figures::from(&evaluate(&model.twin, &test, &scale, None).twin.overall)
            });
            let repeatability = repeatability(&presses, &scale);
            let metrics = self.metrics(&model, &evaluation, every_taxel, repeatability.as_ref())?;
            write_json(
                &folder.join("evaluation.json"),
                &HeldOut {
                    evaluation,
                    repeatability,
                },
            )?;
            write_json(&folder.join("metrics.json"), &metrics)
        })
    }

    fn metrics(
        &self,
        model: &Model,
        evaluation: &Evaluation,
        every_taxel: Option<Figures>,
        repeatability: Option<&Repeatability>,
    ) -> Result<Metrics> {
        let variants: Vec<super::training::VariantRecord> =
            read_json(&self.stage("training").join("variants.json"))?;
        Ok(Metrics {
            sensor: self.record.sensor.clone(),
            provenance: model.record.provenance,
            definition: evaluation.twin.definition.clone(),
            taxels_left_out: names(self.left_out(), &evaluation.taxels),
            variant: evaluation.variant.to_string(),
            held_out_presses: evaluation.presses.len(),
            twin: TwinFigures::new(&evaluation.twin, &evaluation.taxels),
            twin_all_taxels: every_taxel,
            baselines: baselines(evaluation),
            repeatability: crate::metrics::repeatability(repeatability),
            variants: variants
                .iter()
                .map(|v| (v.variant.to_string(), Figures::from(&v.test.overall)))
                .collect(),
            seed: self.record.seed,
        })
    }

    /// What the evaluation stage left.
    pub fn evaluation(&self) -> Result<(HeldOut, Metrics)> {
        let folder = self.stage("evaluation");
        let held_out = read_json(&folder.join("evaluation.json")).context("run `twintac evaluate` first")?;
        Ok((held_out, read_json(&folder.join("metrics.json"))?))
    }
}

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
    /// Errors after each new file's contact height was fitted to its first presses, which are not scored.
    #[serde(flatten)]
    pub twin: TwinFigures,
    /// Errors on the same presses with contact heights as at training: what the twin says without having touched the gel once.
    pub uncalibrated: Figures,
    /// Predicting nothing, on the same presses.
    pub baselines: BaselineFigures,
    /// How well the presses themselves repeat.
    pub repeatability: Option<Figures>,
    /// Contact heights of files that the model had not seen.
    pub contact: Vec<Recalibration>,
}

/// Judges a model on other recordings of its sensor: simulates their places, fits each new file's contact height, and scores the rest.
pub fn evaluate_elsewhere(model_folder: &Path, recording: &Recording) -> Result<UnseenEvaluation> {
    let model = Model::load(model_folder)?;
    let record = &model.record;
    if recording.taxels != record.taxels {
        bail!(
            "the model reads taxels {:?}, the recordings have {:?}",
            record.taxels,
            recording.taxels
        );
    }
    let sensor = Arc::new(parse_sensor(&model_folder.join("twin.json"), &record.sensor)?);
    let settings: SimulateSettings = serde_json::from_value(record.simulation.clone())
        .with_context(|| format!("{}: settings of the simulation", model_folder.display()))?;
    let left_out = left_out(&sensor);
    let gel = Gel::new(sensor, settings);
    let folder = tempfile::tempdir().context("making a temporary folder for simulations")?;
    let bar = progress::bar("simulating", 0);
    let store = DepthTableStore::new(&gel, folder.path().to_owned(), bar.clone());
    let places = Places::of(recording, &store, &digitac::PlaceSettings::default())?.at_bench(&record.bench);
    let tables = store
        .depth_tables(&places.requests)
        .map_err(anyhow::Error::from_boxed)?;
    bar.finish_and_clear();

    let mut bench = record.bench.clone();
    let mut contact = Vec::new();
    let mut spent = BTreeSet::new();
    for file in new_files(recording, &bench.contact_offset_mm) {
        let found = recalibrate(
            recording,
            (&places, &tables),
            &bench,
            &model.twin,
            &file,
            CONTACT_LIMIT_MM,
            &left_out,
        )?;
        if let Some(found) = found {
            spent.extend(found.used.iter().copied());
            contact.push(found);
        }
    }
    for found in &contact {
        bench
            .contact_offset_mm
            .insert(found.file.clone(), found.contact_offset_mm);
    }
    let settings = digitac::PairSettings::default();
    let judge = |bench: &digitac::Bench| -> Result<(Evaluation, Option<Repeatability>)> {
        let presses = pair(recording, &places, &tables, bench, &settings)?;
        let scale = Scale::of(&presses, left_out.clone());
        let scored: Vec<_> = presses
            .iter()
            .enumerate()
            .filter(|(index, _)| !spent.contains(index))
            .map(|(_, press)| press)
            .collect();
        Ok((
            evaluate(&model.twin, &scored, &scale, None),
            repeatability(&presses, &scale),
        ))
    };
    let (evaluation, repeats) = judge(&bench)?;
    let (uncalibrated, _) = judge(&record.bench)?;
    Ok(UnseenEvaluation {
        provenance: recording.provenance,
        definition: evaluation.twin.definition.clone(),
        taxels_left_out: names(left_out, &record.taxels),
        variant: record.variant.to_string(),
        presses: evaluation.presses.len(),
        twin: TwinFigures::new(&evaluation.twin, &record.taxels),
        uncalibrated: Figures::from(&uncalibrated.twin.overall),
        baselines: baselines(&evaluation),
        repeatability: crate::metrics::repeatability(repeats.as_ref()),
        contact,
    })
}

fn new_files(recording: &Recording, known: &BTreeMap<String, Estimate>) -> BTreeSet<String> {
    let files = recording.presses.iter().map(|press| press.mounting.clone());
    files.filter(|file| !known.contains_key(file)).collect()
}

fn names(indices: BTreeSet<usize>, taxels: &[String]) -> Vec<String> {
    indices
        .into_iter()
        .filter_map(|index| taxels.get(index).cloned())
        .collect()
}
