//! Stage `evaluation`: the twin on presses that it never saw.

use std::collections::BTreeSet;

use digitac::{
    Baselines, CertaintyScore, Evaluation, Model, PairedPress, Repeatability, Scale, evaluate, repeatability,
    score_certainty,
};
use serde::{Deserialize, Serialize};

use super::training::VariantRecord;
use crate::error::At;
use crate::files::{read_json, write_json};
use crate::metrics::{self, Figures, Metrics, TwinFigures, baselines, names};
use crate::settings::ports_mm;
use crate::{Run, RunError};

/// What the evaluation stage left: `evaluation.json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct HeldOut {
    /// The twin on presses that it never saw.
    pub(crate) evaluation: Evaluation,
    /// How well the presses themselves repeat.
    pub(crate) repeatability: Option<Repeatability>,
}

impl Run {
    /// Judges the twin that was trained without the test presses on these, and says how well it did.
    ///
    /// # Errors
    /// No twin is trained yet.
    pub fn evaluate(&self) -> Result<Metrics, RunError> {
        let inputs = self
            .inputs()
            .file(&self.folder.join("sensor.toml"))?
            .stage(&self.stage("simulation"))?
            .stage(&self.stage("pairs"))?
            .stage(&self.stage("training"))?;
        self.run_stage("evaluation", inputs, |folder| {
            let presses = self.pairs()?;
            let model = Model::load(&self.stage("training").join("held-out"))?;
            let split = &model.record.split;
            let teachers = [&split.train[..], &split.validation].concat();
            let baselines = Baselines::fit(
                &presses,
                &teachers,
                &ports_mm(&self.sensor.sensor),
                &self.left_out(),
            )?;
            let scale = Scale::of(&presses, self.left_out());
            let evaluation = evaluate(&model.twin, &presses, &split.test, &scale, Some(&baselines));
            let every_taxel = (!self.left_out().is_empty()).then(|| {
                let scale = Scale::of(&presses, BTreeSet::new());
                Figures::from(
                    &evaluate(&model.twin, &presses, &split.test, &scale, None)
                        .twin
                        .overall,
                )
            });
            let repeatability = repeatability(&presses, &scale);
            let certainty = self.certainty(&model, &presses, &scale)?;
            let mut metrics = self.figures(&model, &evaluation, every_taxel, repeatability.as_ref())?;
            metrics.certainty = certainty;
            write_json(
                &folder.join("evaluation.json"),
                &HeldOut {
                    evaluation,
                    repeatability,
                },
            )?;
            write_json(&folder.join("metrics.json"), &metrics)
        })?;
        self.metrics()
    }

    /// Whether the twin's intervals hold on the presses that it never saw.
    fn certainty(
        &self,
        model: &Model,
        presses: &[PairedPress],
        scale: &Scale,
    ) -> Result<Option<CertaintyScore>, RunError> {
        let Some(certainty) = &model.record.certainty else {
            return Ok(None);
        };
        let simulation = self.simulation(&self.recording()?)?;
        let contacts = self.contacts(&simulation.places)?;
        let (twin, places) = ((&model.twin, certainty), (&simulation.places, &contacts[..]));
        let test = &model.record.split.test;
        Ok(Some(score_certainty(twin, presses, places, test, scale)))
    }

    /// The figures of the run: what `metrics.json` holds.
    ///
    /// # Errors
    /// The run is not evaluated yet.
    pub fn metrics(&self) -> Result<Metrics, RunError> {
        let path = self.stage("evaluation").join("metrics.json");
        read_json(&path).at(|| "run `twintac evaluate` first".to_owned())
    }

    fn figures(
        &self,
        model: &Model,
        evaluation: &Evaluation,
        every_taxel: Option<Figures>,
        repeatability: Option<&Repeatability>,
    ) -> Result<Metrics, RunError> {
        let variants: Vec<VariantRecord> = read_json(&self.stage("training").join("variants.json"))?;
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
            repeatability: metrics::repeatability(repeatability),
            variants: variants
                .iter()
                .map(|v| (v.variant.to_string(), Figures::from(&v.test.overall)))
                .collect(),
            certainty: None,
            seed: self.record.seed,
        })
    }

    /// What the evaluation stage left.
    pub(crate) fn held_out(&self) -> Result<HeldOut, RunError> {
        let path = self.stage("evaluation").join("evaluation.json");
        read_json(&path).at(|| "run `twintac evaluate` first".to_owned())
    }
}
