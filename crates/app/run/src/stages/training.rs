//! Stage `training`: every variant of the twin, the one that validation presses choose, and that one again on all presses.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use digitac::{
    Epoch, Model, Origin, Progress, Scale, Score, Split, StaticPolynomial, TrainSettings, Trained, Variant,
};
use serde::{Deserialize, Serialize};

use crate::cache::{Inputs, write_json};
use crate::progress;
use crate::run::Run;

/// How each variant did: `variants.json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct VariantRecord {
    /// Which.
    pub variant: Variant,
    /// Whether it was chosen.
    pub chosen: bool,
    /// Its errors on validation presses, by which the choice was made.
    pub validation: Score,
    /// Its errors on test presses, which nothing was chosen by.
    pub test: Score,
    /// Its losses.
    pub history: Vec<Epoch>,
}

impl Run {
    /// Trains the variants without the test presses, then the chosen one with them.
    pub fn train(&self) -> Result<()> {
        let inputs = Inputs::new()?
            .settings("settings", &self.record.settings)?
            .settings("seed", &self.record.seed)?
            .file(&self.folder.join("sensor.toml"))?
            .stage(&self.stage("simulation"))?
            .stage(&self.stage("pairs"))?;
        self.run_stage("training", inputs, |folder| {
            let recording = self.recording()?;
            let simulation = self.simulation(&recording)?;
            let presses = self.pairs()?;
            let settings = self.resolved(&recording, &simulation.places).train;
            let scale = Scale::of(&presses, self.left_out());
            let n_steps = settings.epochs * (settings.variants.len() + 1);
            let bar = progress::bar("training", n_steps as u64);
            let mut done: BTreeMap<Variant, usize> = BTreeMap::new();
            let mut follow = |step: Progress| {
                done.insert(step.variant, step.epoch);
                bar.set_message(format!("{} {:.2} %", step.variant, 100.0 * step.validation_loss));
                bar.set_position(done.values().sum::<usize>() as u64);
            };
            let fit = |split: &Split, settings: &TrainSettings, follow: &mut dyn FnMut(Progress)| {
                digitac::train(&presses, &recording.taxels, split, &scale, settings, follow)
            };
            let trained = fit(&simulation.split, &settings, &mut follow)?;
            let chosen = digitac::choose(&trained).context("no variant was trained")?;

            let test: Vec<_> = simulation
                .split
                .test
                .iter()
                .map(|&index| &presses[index])
                .collect();
            let teaching: Vec<_> = simulation
                .split
                .train
                .iter()
                .map(|&index| &presses[index])
                .collect();
            let polynomial = StaticPolynomial::fit(&teaching);
            let mut variants = Vec::new();
            for candidate in &trained {
                variants.push(VariantRecord {
                    variant: candidate.twin.variant(),
                    chosen: std::ptr::eq(candidate, chosen),
                    validation: candidate.validation.clone(),
                    test: digitac::evaluate(&candidate.twin, &test, &scale, None).twin,
                    history: candidate.history.clone(),
                });
            }
            write_json(&folder.join("variants.json"), &variants)?;

            let keep = |trained: &Trained, split: Split, name: &str| -> Result<()> {
                let origin = Origin {
                    sensor: self.sensor.text.clone(),
                    simulation: serde_json::to_value(&self.record.settings.simulate)?,
                    bench: simulation.bench.clone(),
                    settings: settings.clone(),
                    provenance: recording.provenance,
                    files: files(&recording),
                    split: split.clone(),
                };
                let judged = (!split.test.is_empty())
                    .then(|| digitac::evaluate(&trained.twin, &test, &scale, Some(&polynomial)));
                let model = Model::new(
                    trained.twin.clone(),
                    origin,
                    trained.validation.clone(),
                    judged.as_ref(),
                );
                model.save(&folder.join(name))?;
                Ok(())
            };
            keep(chosen, simulation.split.clone(), "held-out")?;

            let mut everything = simulation.split.clone();
            everything.train.append(&mut everything.test);
            everything.train.sort_unstable();
            let again = TrainSettings {
                variants: vec![chosen.twin.variant()],
                ..settings.clone()
            };
            let complete = fit(&everything, &again, &mut |_| bar.inc(1))?;
            keep(
                complete.first().context("no variant was trained")?,
                everything,
                "complete",
            )?;
            bar.finish_and_clear();
            Ok(())
        })?;
        self.publish_model()
    }

    /// Puts the twin of all presses where people look for it.
    fn publish_model(&self) -> Result<()> {
        let target = self.folder.join("model");
        let model = Model::load(&self.stage("training").join("complete"))?;
        if Model::load(&target).is_ok_and(|there| there.record == model.record) {
            return Ok(());
        }
        model.save(&target).map_err(Into::into)
    }
}

fn files(recording: &twintac_recording::Recording) -> Vec<String> {
    let mut files: Vec<String> = recording
        .presses
        .iter()
        .map(|press| press.mounting.clone())
        .collect();
    files.sort_unstable();
    files.dedup();
    files
}
