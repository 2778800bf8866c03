//! Telling shapes by touch with few real presses and many simulated ones (the paper's section IV-C).

use std::path::Path;

use rand::seq::SliceRandom;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use twintac_classify::{Classifier, Confusion, Progress, Sampling, Series, TrainSettings, Trial};
use twintac_random::stream;
use twintac_recording::Recording;

use super::experiments::Paper;
use super::mixture::{Mixture, Simulated};
use crate::RunError;
use crate::files::{read_json, write_json};
use crate::progress::Work;

/// Few trials of the bench among many simulated ones are shown so often that there are no more than this many of those for each.
const SIMULATED_PER_REAL: usize = 5;

/// So often a training says how it goes.
const SAYINGS: usize = 20;

/// One way to train, over all seeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShapesResult {
    /// What was trained with.
    #[serde(flatten)]
    pub mixture: Mixture,
    /// Part of the test trials whose shape is told, seed by seed, %.
    pub accuracy_percent: Vec<f64>,
    /// All seeds together.
    pub confusion: Confusion,
}

/// A training to do.
struct Job {
    mixture: Mixture,
    seed: u64,
}

impl Job {
    fn name(&self) -> String {
        let Mixture {
            real_trials,
            simulated,
            simulated_trials,
            sampling,
        } = self.mixture;
        let (simulated, seed) = (simulated.name(), self.seed);
        format!("{real_trials}-real-{simulated_trials}-{simulated}-by-{sampling}-seed-{seed}")
    }
}

/// The trials of the bench and of the twins, sampled one way.
struct Trials {
    real: Vec<Trial>,
    twin: Vec<Trial>,
    paper_twin: Vec<Trial>,
}

impl Trials {
    fn read(paper: &Paper, sampling: Sampling) -> Result<Self, RunError> {
        let classes = paper.shape_names();
        let read = |file: &str| trials_of(&paper.folder.join(file), &classes, sampling);
        Ok(Self {
            real: read("trials/recordings/presses.parquet")?,
            twin: read("simulated/twin.parquet")?,
            paper_twin: read("simulated/paper-twin.parquet")?,
        })
    }

    /// What to learn from, and what to test with. The bench's trials of each shape are halved anew for each seed: so many of the first half to learn
    /// from, all of the second to test with. The simulated ones are drawn anew as well.
    fn divide(&self, n_classes: usize, job: &Job) -> (Vec<Trial>, Vec<Trial>) {
        let Mixture {
            real_trials,
            simulated,
            simulated_trials,
            ..
        } = job.mixture;
        let made: &[Trial] = match simulated {
            Simulated::None => &[],
            Simulated::Twin => &self.twin,
            Simulated::PaperTwin => &self.paper_twin,
        };
        let (mut train, mut test) = (Vec::new(), Vec::new());
        for class in 0..n_classes {
            let shuffled = |trials: &[Trial], name: &str| {
                let mut own: Vec<Trial> = trials.iter().filter(|t| t.class == class).cloned().collect();
                own.shuffle(&mut stream(job.seed, &format!("paper/{name}/{class}")));
                own
            };
            let mut learned = shuffled(&self.real, "shapes");
            test.extend(learned.split_off(learned.len() / 2));
            learned.truncate(real_trials);
            let shown = (simulated_trials / (SIMULATED_PER_REAL * real_trials.max(1))).max(1);
            (0..shown).for_each(|_| train.extend(learned.iter().cloned()));
            train.extend(shuffled(made, "simulated").into_iter().take(simulated_trials));
        }
        (train, test)
    }
}

impl Paper {
    /// Trains on real and simulated trials in every mixture, and tests on real ones.
    pub(super) fn classify(&self) -> Result<Vec<ShapesResult>, RunError> {
        let settings = self.effort.classifier();
        let inputs = self
            .inputs()
            .settings("settings", &settings)?
            .settings("effort", &self.effort)?
            .stage(&self.folder.join("trials/recordings"))?
            .stage(&self.folder.join("simulated"))?;
        self.run_stage("shapes", inputs, |folder| {
            let by_load = Trials::read(self, Sampling::Load)?;
            let by_time = Trials::read(self, Sampling::Time)?;
            let jobs = self.jobs();
            let work = Work::start(self.progress(), "learning shapes", SAYINGS * jobs.len());
            let confusions: Vec<Confusion> = jobs
                .par_iter()
                .with_max_len(1)
                .map(|job| {
                    let path = folder.join("trainings").join(job.name()).with_extension("json");
                    if let Ok(confusion) = read_json(&path) {
                        (0..SAYINGS).for_each(|_| work.step(""));
                        return Ok(confusion);
                    }
                    let seen = match job.mixture.sampling {
                        Sampling::Load => &by_load,
                        Sampling::Time => &by_time,
                    };
                    let confusion = self.train(job, seen, &settings, &work)?;
                    write_json(&path, &confusion)?;
                    Ok(confusion)
                })
                .collect::<Result<_, RunError>>()?;
            write_json(&folder.join("result.json"), &results(&jobs, confusions))
        })?;
        read_json(&self.folder.join("shapes/result.json"))
    }

    fn train(
        &self,
        job: &Job,
        trials: &Trials,
        settings: &TrainSettings,
        work: &Work<'_>,
    ) -> Result<Confusion, RunError> {
        let n_classes = self.shape_names().len();
        let (train, test) = trials.divide(n_classes, job);
        let name = job.name();
        let mut said = 0;
        let mut say = |progress: Progress| {
            let due = SAYINGS * progress.epoch / progress.of;
            for _ in said..due {
                work.step(&format!("{name}: loss {:.3}", progress.loss));
            }
            said = due;
        };
        let classifier = Classifier::train(&train, n_classes, settings, job.seed, &mut say)?;
        Ok(classifier.judge(&test))
    }

    /// The shapes in the order of their classes.
    pub(super) fn shape_names(&self) -> Vec<String> {
        let indenters = self.sensor.sensor.indenters.iter();
        indenters.map(|indenter| indenter.name.clone()).collect()
    }

    fn jobs(&self) -> Vec<Job> {
        let seeds = 1..=self.effort.seeds();
        let mixtures = self.effort.mixtures().into_iter();
        mixtures
            .flat_map(|mixture| seeds.clone().map(move |seed| Job { mixture, seed }))
            .collect()
    }
}

/// The trials of a recording's presses, those of each shape in their order. A press that is not felt is left out, and one with missing readings.
fn trials_of(file: &Path, classes: &[String], sampling: Sampling) -> Result<Vec<Trial>, RunError> {
    let recording = Recording::read_parquet(file)?;
    let trial = |press: &twintac_recording::Press| {
        Some(Trial {
            class: classes.iter().position(|class| *class == press.indenter)?,
            series: Series::of(whole(press)?, sampling)?,
        })
    };
    Ok(recording.presses.iter().filter_map(trial).collect())
}

/// The readings of a press that misses none.
fn whole(press: &twintac_recording::Press) -> Option<&[Vec<f64>]> {
    let is_whole = press.taxels_kpa.iter().flatten().all(|kpa| kpa.is_finite());
    is_whole.then_some(&press.taxels_kpa)
}

fn results(jobs: &[Job], confusions: Vec<Confusion>) -> Vec<ShapesResult> {
    let mut results: Vec<ShapesResult> = Vec::new();
    for (job, confusion) in jobs.iter().zip(confusions) {
        let accuracy = confusion.accuracy_percent();
        match results.last_mut().filter(|last| last.mixture == job.mixture) {
            Some(last) => {
                last.accuracy_percent.push(accuracy);
                last.confusion.add(&confusion);
            }
            None => results.push(ShapesResult {
                mixture: job.mixture,
                accuracy_percent: vec![accuracy],
                confusion,
            }),
        }
    }
    results
}
