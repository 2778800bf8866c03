//! Classification of shapes by touch from few real presses and many simulated ones (the paper's
//! section IV-C).

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use rand::seq::SliceRandom;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use twintac_classify::{Classifier, Confusion, Sampling, Series, TrainSettings, Trial};
use twintac_random::stream;
use twintac_recording::Recording;
use twintac_run::read_recording;
use twintac_store::{Finished, Keyed, Recipe, Stage, Store, read_json, write_json};
use twintac_work::{Progress, Work, WorkError};

use crate::experiments::{PAPER_COMMAND, Paper};
use crate::mixture::{Mixture, Simulated};

/// Bench trials are repeated in the training set if they are few, so that there are at most this
/// many simulated trials for each.
const SIMULATED_PER_REAL: usize = 5;

/// Number of progress reports of a training.
const SAYINGS: usize = 20;

/// The result of one training set, over all seeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShapesResult {
    /// The training set.
    #[serde(flatten)]
    pub mixture: Mixture,
    /// Percentage of the test trials whose shape is classified correctly, seed by seed.
    pub accuracy_percent: Vec<f64>,
    /// Confusion matrix of all seeds together.
    pub confusion: Confusion,
}

/// One training: a training set and a seed.
#[derive(Clone, Copy, Serialize)]
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

/// The inputs of all trainings.
#[derive(Serialize)]
struct Telling {
    classes: Vec<String>,
    settings: TrainSettings,
    jobs: Vec<Job>,
    /// Trials on the bench.
    trials: Finished,
    /// Trials of the twins.
    simulated: Finished,
}

impl Stage for Telling {
    const NAME: &'static str = "shapes";
    const MADE_BY: &'static str = PAPER_COMMAND;
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, progress: &dyn Progress) -> Result<(), WorkError> {
        let by_load = self.sampled(Sampling::Load)?;
        let by_time = self.sampled(Sampling::Time)?;
        let work = Work::start(progress, "learning shapes", SAYINGS * self.jobs.len());
        let store = Store::new(&folder.join("trainings"), Self::NAME);
        let confusions: Vec<Confusion> = self
            .jobs
            .par_iter()
            .with_max_len(1)
            .map(|job| {
                let n_said = AtomicUsize::new(0);
                let kept = store.get(&Training {
                    trials: match job.mixture.sampling {
                        Sampling::Load => &by_load,
                        Sampling::Time => &by_time,
                    },
                    n_classes: self.classes.len(),
                    settings: &self.settings,
                    job: *job,
                    said: Said {
                        work: &work,
                        n_said: &n_said,
                    },
                })?;
                (n_said.into_inner()..SAYINGS).for_each(|_| work.step(""));
                Ok(kept.value)
            })
            .collect::<Result<_, WorkError>>()?;
        Ok(write_json(
            &folder.join("result.json"),
            &results(&self.jobs, confusions),
        )?)
    }
}

impl Telling {
    /// The trials as series, sampled in one way.
    fn sampled(&self, sampling: Sampling) -> Result<Keyed<Trials>, WorkError> {
        let read = |recording: Recording| trials_of(&recording, &self.classes, sampling);
        let simulated = |simulated: Simulated| {
            Ok::<_, WorkError>(Recording::read_parquet(&self.simulated.file(&simulated.file()))?)
        };
        let trials = Trials {
            real: read(read_recording(&self.trials)?),
            twin: read(simulated(Simulated::Twin)?),
            paper_twin: read(simulated(Simulated::PaperTwin)?),
        };
        let from = (&self.trials, &self.simulated, &self.classes, sampling);
        Ok(Keyed::from_inputs(trials, &from)?)
    }
}

/// The inputs of one training and its test.
#[derive(Serialize)]
struct Training<'a> {
    trials: &'a Keyed<Trials>,
    n_classes: usize,
    settings: &'a TrainSettings,
    job: Job,
    /// Receives progress reports; the result does not depend on it.
    #[serde(skip)]
    said: Said<'a>,
}

/// The progress reports of a training.
struct Said<'a> {
    work: &'a Work<'a>,
    n_said: &'a AtomicUsize,
}

impl Recipe for Training<'_> {
    type Value = Confusion;
    type Error = WorkError;

    fn label(&self) -> String {
        self.job.name()
    }

    fn make(&self) -> Result<Confusion, WorkError> {
        let (train, test) = self.trials.divide(self.n_classes, &self.job);
        let (name, Said { work, n_said }) = (self.job.name(), &self.said);
        let mut say = |progress: twintac_classify::Progress| {
            let due = SAYINGS * progress.epoch / progress.of;
            for _ in n_said.load(Ordering::Relaxed)..due {
                work.step(&format!("{name}: loss {:.3}", progress.loss));
            }
            n_said.store(due, Ordering::Relaxed);
        };
        let seed = self.job.seed;
        let classifier = Classifier::train(&train, self.n_classes, self.settings, seed, &mut say)?;
        Ok(classifier.evaluate(&test))
    }
}

/// The trials of the bench and of the twins, sampled in one way.
struct Trials {
    real: Vec<Trial>,
    twin: Vec<Trial>,
    paper_twin: Vec<Trial>,
}

impl Trials {
    /// Training and test trials. For each seed the bench's trials of each shape are divided into
    /// two random halves: `real_trials` of the first half are for training, the whole second half
    /// is for testing. The simulated trials are drawn at random as well.
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
    /// Trains on every training set, and tests on trials of the bench.
    pub(super) fn classify(
        &self,
        trials: Finished,
        simulated: Finished,
    ) -> Result<Vec<ShapesResult>, WorkError> {
        let finished = self.run_stage(&Telling {
            classes: self.shape_names(),
            settings: self.effort.classifier(),
            jobs: self.jobs(),
            trials,
            simulated,
        })?;
        Ok(read_json(&finished.file("result.json"))?)
    }

    /// Names of the shapes, in the order of their classes.
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

/// The trials of a recording, those of each shape in their order. Presses without a detected
/// contact, and presses with missing readings, are left out.
fn trials_of(recording: &Recording, classes: &[String], sampling: Sampling) -> Vec<Trial> {
    let trial = |press: &twintac_recording::Press| {
        Some(Trial {
            class: classes.iter().position(|class| *class == press.indenter)?,
            series: Series::of(whole(press)?, sampling)?,
        })
    };
    recording.presses.iter().filter_map(trial).collect()
}

/// The readings of a press, if none is missing.
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
                last.accuracy_percent.extend(accuracy);
                last.confusion.add(&confusion);
            }
            None => results.push(ShapesResult {
                mixture: job.mixture,
                accuracy_percent: accuracy.into_iter().collect(),
                confusion,
            }),
        }
    }
    results
}
