//! Telling shapes by touch with few real presses and many simulated ones (the paper's section IV-C).

use std::path::Path;

use digitac::{Model, simulated_recording};
use rand::seq::SliceRandom;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use twintac_classify::{Classifier, Confusion, Series, Trial};
use twintac_protocol::Protocol;
use twintac_random::stream;
use twintac_recording::Recording;

use super::experiments::Paper;
use crate::built_in::{SHAPES_PROTOCOL, reality};
use crate::depth_tables::DepthTableStore;
use crate::files::{read_json, write_json};
use crate::model::gel_of;
use crate::progress::Work;
use crate::{Planned, Run, RunError};

/// The simulated presses are drawn with another seed than the real ones.
const SIMULATED_SEED: u64 = 1_000_000;

/// Where the simulated trials of a training come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Simulated {
    /// There are none.
    None,
    /// This project's twin.
    Twin,
    /// The paper's twin: its stress feature and its perceptron.
    PaperTwin,
}

impl Simulated {
    const ALL: [Self; 3] = [Self::None, Self::Twin, Self::PaperTwin];

    /// The name used in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Twin => "twin",
            Self::PaperTwin => "paper-twin",
        }
    }
}

/// One way to train, over all seeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShapesResult {
    /// Trials of each shape on the bench.
    pub real_trials: usize,
    /// Where the simulated ones come from.
    pub simulated: Simulated,
    /// How many of them each shape has.
    pub simulated_trials: usize,
    /// Part of the test trials whose shape is told, seed by seed, %.
    pub accuracy_percent: Vec<f64>,
    /// All seeds together.
    pub confusion: Confusion,
}

/// A training and what it is worth.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Trained {
    confusion: Confusion,
}

/// A training to do.
struct Job {
    seed: u64,
    real_trials: usize,
    simulated: Simulated,
}

impl Job {
    fn name(&self) -> String {
        let simulated = self.simulated.name();
        format!("{}-real-{simulated}-seed-{}", self.real_trials, self.seed)
    }
}

impl Paper {
    /// The presses of the bench that shapes are told by.
    pub(super) fn trials(&self) -> Result<Run, RunError> {
        let planned = self.shapes(2 * self.effort.real_trials(), self.seed)?;
        let source = format!("{} trials on the emulated bench", planned.presses.len());
        let run = self.run("trials", &source)?;
        run.emulate(&reality(Some(Path::new(self.effort.reality())))?, &planned)?;
        Ok(run)
    }

    fn shapes(&self, n_trials: u32, seed: u64) -> Result<Planned, RunError> {
        let protocol = Protocol::parse(SHAPES_PROTOCOL.name, SHAPES_PROTOCOL.text)?;
        Planned::of(&protocol.with_random_places(n_trials), &self.sensor.sensor, seed)
    }

    /// Presses that the twins of a run would feel.
    pub(super) fn simulated(&self, data: &Run) -> Result<(), RunError> {
        let planned = self.shapes(self.effort.simulated_trials(), self.seed + SIMULATED_SEED)?;
        let models = [
            (Simulated::Twin, data.model_folder()),
            (Simulated::PaperTwin, data.paper_twin_folder()),
        ];
        let mut inputs = self.inputs().settings("plans", &planned.presses)?;
        for (_, folder) in &models {
            inputs = inputs
                .file(&folder.join("weights.safetensors"))?
                .file(&folder.join("twin.json"))?;
        }
        self.run_stage("simulated", inputs, |folder| {
            let _work = Work::start(self.progress(), "simulating trials", 0);
            for (simulated, model_folder) in &models {
                let model = Model::load(model_folder)?;
                let gel = gel_of(&model, model_folder)?;
                let store = DepthTableStore::new(&gel, folder.join("depth_tables"), self.progress());
                let rate_hz = gel.sensor().readout.rate_hz;
                let bench = &model.record.bench;
                let mut recording =
                    simulated_recording(&model.twin, bench, &store, &planned.presses, rate_hz)?;
                recording.sensor.clone_from(&gel.sensor().name);
                recording.write_parquet(&folder.join(simulated.name()).with_extension("parquet"))?;
            }
            Ok(())
        })
    }

    /// Trains on real and simulated trials in every mixture, and tests on real ones.
    pub(super) fn classify(&self) -> Result<Vec<ShapesResult>, RunError> {
        let (trials, simulated) = (self.folder.join("trials"), self.folder.join("simulated"));
        let settings = self.effort.classifier();
        let inputs = self
            .inputs()
            .settings("settings", &settings)?
            .settings("effort", &self.effort)?
            .stage(&trials.join("recordings"))?
            .stage(&simulated)?;
        self.run_stage("shapes", inputs, |folder| {
            let classes: Vec<String> = self.shape_names();
            let real = trials_of(&trials.join("recordings/presses.parquet"), &classes)?;
            let made = |simulated_by: Simulated| match simulated_by {
                Simulated::None => Ok(Vec::new()),
                other => trials_of(&simulated.join(other.name()).with_extension("parquet"), &classes),
            };
            let simulated: Vec<Vec<Trial>> =
                Simulated::ALL.map(made).into_iter().collect::<Result<_, _>>()?;
            let jobs = self.jobs();
            let work = Work::start(self.progress(), "learning shapes", jobs.len());
            let trained: Vec<Trained> = jobs
                .par_iter()
                .with_max_len(1)
                .map(|job| {
                    let path = folder.join("trainings").join(job.name()).with_extension("json");
                    if let Ok(trained) = read_json::<Trained>(&path) {
                        work.step("");
                        return Ok(trained);
                    }
                    let (mut train, test) = divide(&real, classes.len(), job);
                    train.extend(simulated[job.simulated as usize].iter().cloned());
                    let classifier =
                        Classifier::train(&train, classes.len(), &settings, job.seed, &mut |_| ())?;
                    let trained = Trained {
                        confusion: classifier.judge(&test),
                    };
                    write_json(&path, &trained)?;
                    work.step(&format!("{:.1} %", trained.confusion.accuracy_percent()));
                    Ok(trained)
                })
                .collect::<Result<_, RunError>>()?;
            let n_simulated = self.effort.simulated_trials() as usize;
            write_json(&folder.join("result.json"), &results(&jobs, trained, n_simulated))
        })?;
        read_json(&self.folder.join("shapes/result.json"))
    }

    /// The shapes in the order of their classes.
    pub(super) fn shape_names(&self) -> Vec<String> {
        let indenters = self.sensor.sensor.indenters.iter();
        indenters.map(|indenter| indenter.name.clone()).collect()
    }

    fn jobs(&self) -> Vec<Job> {
        let mut jobs = Vec::new();
        for &real_trials in self.effort.curve() {
            for simulated in Simulated::ALL {
                if real_trials > 0 || simulated != Simulated::None {
                    jobs.extend((1..=self.effort.seeds()).map(|seed| Job {
                        seed,
                        real_trials,
                        simulated,
                    }));
                }
            }
        }
        jobs
    }
}

/// The trials of a recording's presses, those of each shape in their order. A press that is not felt is left out.
fn trials_of(file: &Path, classes: &[String]) -> Result<Vec<Trial>, RunError> {
    let recording = Recording::read_parquet(file)?;
    let trial = |press: &twintac_recording::Press| {
        Some(Trial {
            class: classes.iter().position(|class| *class == press.indenter)?,
            series: Series::of(&press.taxels_kpa)?,
        })
    };
    Ok(recording.presses.iter().filter_map(trial).collect())
}

/// The trials of each shape in two halves, drawn anew for each seed: so many of the first half to learn from, and the second half to test with.
fn divide(real: &[Trial], n_classes: usize, job: &Job) -> (Vec<Trial>, Vec<Trial>) {
    let (mut train, mut test) = (Vec::new(), Vec::new());
    for class in 0..n_classes {
        let mut own: Vec<&Trial> = real.iter().filter(|trial| trial.class == class).collect();
        own.shuffle(&mut stream(job.seed, &format!("paper/shapes/{class}")));
        let (first, second) = own.split_at(own.len() / 2);
        train.extend(first.iter().take(job.real_trials).copied().cloned());
        test.extend(second.iter().copied().cloned());
    }
    (train, test)
}

fn results(jobs: &[Job], trained: Vec<Trained>, n_simulated: usize) -> Vec<ShapesResult> {
    let mut results: Vec<ShapesResult> = Vec::new();
    for (job, Trained { confusion }) in jobs.iter().zip(trained) {
        let accuracy = confusion.accuracy_percent();
        match results.last_mut() {
            Some(last) if last.real_trials == job.real_trials && last.simulated == job.simulated => {
                last.accuracy_percent.push(accuracy);
                last.confusion.add(&confusion);
            }
            _ => results.push(ShapesResult {
                real_trials: job.real_trials,
                simulated: job.simulated,
                simulated_trials: if job.simulated == Simulated::None {
                    0
                } else {
                    n_simulated
                },
                accuracy_percent: vec![accuracy],
                confusion,
            }),
        }
    }
    results
}
