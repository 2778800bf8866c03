//! Stage `training`: every variant of the twin, the one that validation presses choose, and that
//! one again with the test presses.

use std::ops::ControlFlow;
use std::path::Path;

use digitac::{
    Certainty, Contact, Epoch, Model, Origin, PairedPress, Progress as Step, Scale, Score, Split,
    TrainSettings, Trained, TrainedWith, TrainingData, Variant, calibrate,
};
use serde::{Deserialize, Serialize};
use twintac_model::{left_out, press_checksum};
use twintac_recording::Recording;
use twintac_store::{Finished, Stage, StoreError, write_json};
use twintac_work::{Progress, Work, WorkError};

use super::pairs::read_pairs;
use super::recordings::read_recording;
use super::simulation::{Setup, Simulation, contacts};
use crate::Run;
use crate::settings::ResolvedSettings;

/// The errors and losses of a variant: `variants.json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct VariantRecord {
    /// The variant.
    pub(crate) variant: Variant,
    /// Whether it was chosen.
    pub(crate) chosen: bool,
    /// Its errors on validation presses. The choice is made by them.
    pub(crate) validation: Score,
    /// Its errors on test presses, which no choice uses.
    pub(crate) test: Score,
    /// Its losses.
    pub(crate) history: Vec<Epoch>,
}

/// Folder in the stage: the twin that was trained without the test presses.
pub(crate) const HELD_OUT: &str = "held-out";

/// Folder in the stage: the twin that was trained on all presses.
pub const COMPLETE: &str = "complete";

/// The inputs of training.
#[derive(Clone, Serialize)]
struct Inputs<'a> {
    #[serde(flatten)]
    setup: Setup<'a>,
    recordings: Finished,
    simulation: Finished,
    pairs: Finished,
}

#[derive(Serialize)]
struct TrainingStage<'a> {
    #[serde(flatten)]
    inputs: Inputs<'a>,
}

impl Stage for TrainingStage<'_> {
    const NAME: &'static str = "training";
    const MADE_BY: &'static str = "twintac train";
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, progress: &dyn Progress) -> Result<(), WorkError> {
        let training = Training::open(&self.inputs)?;
        let work = Work::start(progress, "training", training.n_epochs());
        let split = &training.simulation.split;
        let trained = training.train(split, &training.settings.train, &work)?;
        let chosen = digitac::choose(&trained)?;
        write_json(
            &folder.join("variants.json"),
            &training.variants(&trained, chosen),
        )?;
        let data = training.training_data();
        let certainty = calibrate(&data, split, chosen.twin.variant())?;
        training.keep(chosen, split.clone(), certainty.clone(), &folder.join(HELD_OUT))?;

        let everything = training.everything();
        let again = TrainSettings {
            variants: Some(vec![chosen.twin.variant()]),
            ..training.settings.train.clone()
        };
        let complete = training.train(&everything, &again, &work)?;
        let complete = complete.first().ok_or_else(nothing_trained)?;
        let training_presses = [&everything.train[..], &everything.validation].concat();
        let certainty = certainty.map(|certainty| certainty.with_training_set(&data, &training_presses));
        training.keep(complete, everything, certainty, &folder.join(COMPLETE))
    }
}

/// The network of the paper, trained on all presses.
#[derive(Serialize)]
struct PaperTwin<'a> {
    #[serde(flatten)]
    inputs: Inputs<'a>,
}

impl Stage for PaperTwin<'_> {
    const NAME: &'static str = "paper-twin";
    const MADE_BY: &'static str = "twintac reproduce --paper";
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, progress: &dyn Progress) -> Result<(), WorkError> {
        let training = Training::open(&self.inputs)?;
        let work = Work::start(progress, "training", training.settings.train.epochs);
        let settings = TrainSettings {
            variants: Some(vec![Variant::Paper]),
            ..training.settings.train.clone()
        };
        let everything = training.everything();
        let trained = training.train(&everything, &settings, &work)?;
        let paper = trained.first().ok_or_else(nothing_trained)?;
        training.keep(paper, everything, None, &folder.join(COMPLETE))
    }
}

impl Run {
    /// Trains every variant of the twin without the test presses, then the one that is best on the
    /// validation presses with them. That twin is saved in [`model_folder`](Self::model_folder).
    ///
    /// # Errors
    /// The pairs do not exist yet.
    pub fn train(&self) -> Result<(), WorkError> {
        let finished = self.run_stage(&self.training_stage()?)?;
        // The place where people look for the model.
        let target = self.model_folder();
        let model = Model::load(&finished.file(COMPLETE))?;
        if Model::load(&target).is_ok_and(|there| there.record == model.record) {
            return Ok(());
        }
        Ok(model.save(&target)?)
    }

    /// Trains the network of the paper on all presses, test presses too: a perceptron on the
    /// paper's stress feature.
    ///
    /// # Errors
    /// Earlier stages do not exist, or do not match their present inputs; a training that failed.
    pub fn train_paper_twin(&self) -> Result<Finished, WorkError> {
        let inputs = self.inputs()?;
        self.run_stage(&PaperTwin { inputs })
    }

    fn inputs(&self) -> Result<Inputs<'_>, WorkError> {
        Ok(Inputs {
            setup: self.setup(),
            recordings: self.recordings()?,
            simulation: self.simulation()?,
            pairs: self.pairs()?,
        })
    }

    fn training_stage(&self) -> Result<TrainingStage<'_>, WorkError> {
        let inputs = self.inputs()?;
        Ok(TrainingStage { inputs })
    }

    /// The training stage, if it matches its present inputs.
    ///
    /// # Errors
    /// It does not exist, or does not match its present inputs.
    pub fn training(&self) -> Result<Finished, WorkError> {
        Ok(self.stages().current(&self.training_stage()?)?)
    }
}

fn nothing_trained() -> WorkError {
    WorkError::Input("no variant was trained".to_owned())
}

/// All data of a training, read.
struct Training<'a> {
    setup: &'a Setup<'a>,
    recording: Recording,
    simulation: Simulation,
    presses: Vec<PairedPress>,
    contacts: Vec<Contact>,
    settings: ResolvedSettings,
    block_mm: f64,
    scale: Scale,
}

impl<'a> Training<'a> {
    fn open(inputs: &'a Inputs<'a>) -> Result<Self, WorkError> {
        let setup = &inputs.setup;
        let recording = read_recording(&inputs.recordings)?;
        let simulation = Simulation::read(&inputs.simulation)?;
        let presses = read_pairs(&inputs.pairs)?;
        let settings = setup.resolved(&recording)?;
        let contacts = contacts(&simulation.places, setup.sensor, setup.settings)?;
        let scale = Scale::of(&presses, left_out(&setup.sensor.sensor));
        Ok(Self {
            setup,
            block_mm: settings.split.block_mm_of(&recording)?,
            recording,
            simulation,
            presses,
            contacts,
            settings,
            scale,
        })
    }

    /// A split in which all presses but those of validation are training presses.
    fn everything(&self) -> Split {
        let mut everything = self.simulation.split.clone();
        everything.train.append(&mut everything.test);
        everything.train.sort_unstable();
        everything
    }

    /// The data from which twins are refitted to calibrate the prediction intervals.
    fn training_data(&self) -> TrainingData<'_> {
        TrainingData {
            recording: &self.recording,
            presses: &self.presses,
            places: &self.simulation.places,
            tables: &self.simulation.tables,
            contacts: &self.contacts,
            bench: &self.simulation.bench,
            bench_settings: &self.settings.bench,
            taxels: &self.settings.taxels,
            train: &self.settings.train,
            seed: self.settings.seed,
            block_mm: self.block_mm,
            scale: &self.scale,
        }
    }

    /// Number of epochs of all variants, and of the chosen one once more.
    fn n_epochs(&self) -> usize {
        let TrainSettings { epochs, variants, .. } = &self.settings.train;
        let n_variants = variants.as_ref().map_or(Variant::ALL.len(), Vec::len);
        epochs * (n_variants + 1)
    }

    fn train(
        &self,
        split: &Split,
        settings: &TrainSettings,
        work: &Work<'_>,
    ) -> Result<Vec<Trained>, WorkError> {
        let mut follow = |step: Step| {
            work.step(&format!("{} {:.2} %", step.variant, 100.0 * step.validation_loss));
            work.go_on().map_or(ControlFlow::Break(()), ControlFlow::Continue)
        };
        let taxels = &self.recording.taxels;
        Ok(digitac::train(
            &self.presses,
            taxels,
            split,
            &self.scale,
            settings,
            self.settings.seed,
            &mut follow,
        )?)
    }

    /// The errors of each variant on presses on which it was not trained.
    fn variants(&self, trained: &[Trained], chosen: &Trained) -> Vec<VariantRecord> {
        let test = &self.simulation.split.test;
        let record = |candidate: &Trained| VariantRecord {
            variant: candidate.twin.variant(),
            chosen: std::ptr::eq(candidate, chosen),
            validation: candidate.validation.clone(),
            test: digitac::evaluate(&candidate.twin, &self.presses, test, &self.scale, None).twin,
            history: candidate.history.clone(),
        };
        trained.iter().map(record).collect()
    }

    /// Saves a twin in a folder. `split` says which presses it was trained on.
    fn keep(
        &self,
        trained: &Trained,
        split: Split,
        certainty: Option<Certainty>,
        folder: &Path,
    ) -> Result<(), WorkError> {
        let evaluation = (!split.test.is_empty()).then(|| {
            let held_out = &self.simulation.split;
            digitac::evaluate(&trained.twin, &self.presses, &held_out.test, &self.scale, None)
        });
        let settings = self.setup.settings;
        let origin = Origin {
            sensor: self.setup.sensor.text.clone(),
            surfaces: self.setup.sensor.surfaces().clone(),
            simulation: serde_json::to_value(&settings.simulate).map_err(|source| StoreError::Json {
                what: "the settings of the simulation".to_owned(),
                source,
            })?,
            bench: self.simulation.bench.clone(),
            settings: TrainedWith {
                settings: self.settings.train.clone(),
                seed: self.settings.seed,
            },
            provenance: self.recording.provenance,
            files: files(&self.recording),
            trained_on: split
                .train
                .iter()
                .chain(&split.validation)
                .map(|&press| press_checksum(&self.recording.presses[press]))
                .collect(),
            temperature: settings.temperature.clone(),
            split,
            certainty,
        };
        let model = Model::new(
            trained.twin.clone(),
            origin,
            trained.validation.clone(),
            evaluation.as_ref(),
        );
        Ok(model.save(folder)?)
    }
}

fn files(recording: &Recording) -> Vec<String> {
    let mut files: Vec<String> = recording
        .presses
        .iter()
        .map(|press| press.mounting.clone())
        .collect();
    files.sort_unstable();
    files.dedup();
    files
}
