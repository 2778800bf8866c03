//! Stage `evaluation`: the twin on presses on which it was not trained.

use std::collections::BTreeSet;
use std::path::Path;

use digitac::{Baselines, Evaluation, Model, Repeatability, Scale, evaluate, repeatability, score_certainty};
use serde::{Deserialize, Serialize};
use twintac_model::{BaselineFigures, Figures, TwinFigures, left_out, names, ports_mm};
use twintac_sensor::SensorFile;
use twintac_store::{Finished, Keyed, Stage, read_json, write_json};
use twintac_work::{Progress, WorkError};

use super::pairs::read_pairs;
use super::simulation::{Simulation, contacts};
use super::training::{HELD_OUT, VariantRecord};
use crate::metrics::Metrics;
use crate::{Run, RunSettings};

/// The result of the evaluation stage: `evaluation.json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct HeldOut {
    /// The twin's errors on the test presses.
    pub(crate) evaluation: Evaluation,
    /// Repeatability of the presses themselves.
    pub(crate) repeatability: Option<Repeatability>,
}

#[derive(Serialize)]
struct Evaluating<'a> {
    sensor: &'a Keyed<SensorFile>,
    settings: &'a RunSettings,
    seed: u64,
    recordings: Finished,
    simulation: Finished,
    pairs: Finished,
    training: Finished,
}

impl Stage for Evaluating<'_> {
    const NAME: &'static str = "evaluation";
    const MADE_BY: &'static str = "twintac evaluate";
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, _: &dyn Progress) -> Result<(), WorkError> {
        let sensor = &self.sensor.sensor;
        let presses = read_pairs(&self.pairs)?;
        let model = Model::load(&self.training.file(HELD_OUT))?;
        let split = &model.record.split;
        let training_presses = [&split.train[..], &split.validation].concat();
        let left_out = left_out(sensor);
        let baselines = Baselines::fit(&presses, &training_presses, &ports_mm(sensor), &left_out)?;
        let scale = Scale::of(&presses, left_out.clone());
        let evaluation = evaluate(&model.twin, &presses, &split.test, &scale, Some(&baselines));
        let every_taxel = (!left_out.is_empty()).then(|| {
            let scale = Scale::of(&presses, BTreeSet::new());
            let all = evaluate(&model.twin, &presses, &split.test, &scale, None);
            Figures::from(&all.twin.overall)
        });
        let repeatability = repeatability(&presses, &scale);
        let certainty = match &model.record.certainty {
            Some(certainty) => {
                let simulation = Simulation::read(&self.simulation)?;
                let contacts = contacts(&simulation.places, self.sensor, self.settings)?;
                let (twin, places) = ((&model.twin, certainty), (&simulation.places, &contacts[..]));
                Some(score_certainty(twin, &presses, places, &split.test, &scale))
            }
            None => None,
        };
        let variants: Vec<VariantRecord> = read_json(&self.training.file("variants.json"))?;
        let metrics = Metrics {
            sensor: sensor.name.clone(),
            provenance: model.record.provenance,
            definition: evaluation.twin.definition.clone(),
            taxels_left_out: names(left_out, &evaluation.taxels),
            variant: evaluation.variant.to_string(),
            held_out_presses: evaluation.presses.len(),
            twin: TwinFigures::new(&evaluation.twin, &evaluation.taxels),
            twin_all_taxels: every_taxel,
            baselines: BaselineFigures::from(&evaluation),
            repeatability: repeatability.as_ref().map(|found| Figures::from(&found.errors)),
            variants: variants
                .iter()
                .map(|v| (v.variant.to_string(), Figures::from(&v.test.overall)))
                .collect(),
            certainty,
            seed: self.seed,
        };
        let held_out = HeldOut {
            evaluation,
            repeatability,
        };
        write_json(&folder.join("evaluation.json"), &held_out)?;
        Ok(write_json(&folder.join("metrics.json"), &metrics)?)
    }
}

impl Run {
    /// Evaluates the twin that was trained without the test presses on these, and returns its
    /// errors.
    ///
    /// # Errors
    /// No twin is trained yet.
    pub fn evaluate(&self) -> Result<Metrics, WorkError> {
        let finished = self.run_stage(&self.evaluating()?)?;
        Ok(read_json(&finished.file("metrics.json"))?)
    }

    fn evaluating(&self) -> Result<Evaluating<'_>, WorkError> {
        Ok(Evaluating {
            sensor: self.keyed_sensor(),
            settings: self.settings(),
            seed: self.record().seed,
            recordings: self.recordings()?,
            simulation: self.simulation()?,
            pairs: self.pairs()?,
            training: self.training()?,
        })
    }

    /// The evaluation stage, if it matches its present inputs.
    pub(crate) fn evaluation(&self) -> Result<Finished, WorkError> {
        Ok(self.stages().current(&self.evaluating()?)?)
    }

    /// The figures of the run: the content of `metrics.json`.
    ///
    /// # Errors
    /// The run is not evaluated yet, or its evaluation does not match its present inputs.
    pub fn metrics(&self) -> Result<Metrics, WorkError> {
        Ok(read_json(&self.evaluation()?.file("metrics.json"))?)
    }
}
