//! Many environments of one task.

use std::sync::Arc;

use rayon::prelude::*;
use twintac_fast::FastGel;
use twintac_sensors::{SensorBatch, SensorVariation, most_sensors};

use crate::answers::{Answers, Autoreset};
use crate::chunk::{Chunk, Steps};
use crate::explore_shape::ExploreShape;
use crate::follow_edge::FollowEdge;
use crate::hold_force::HoldForce;
use crate::picture::Shown;
use crate::task::Task;
use crate::{Kind, TaskError};

/// Many environments of one task, with the memory that steps need.
pub struct Tasks {
    chunks: Vec<Box<dyn Steps>>,
    /// Environments of each chunk but the last.
    of_chunk: usize,
    n_environments: usize,
    n_observed: usize,
    n_actions: usize,
    figures: &'static [&'static str],
    autoreset: Autoreset,
    shown: Shown,
}

impl Tasks {
    /// Environments, distributed over threads. The seed of environment `n` is `n` until
    /// [`Self::seed`] sets another. Each episode has another sensor, drawn from `variation`.
    ///
    /// # Errors
    /// No environment, or more than [`most_sensors`].
    pub fn new(
        kind: Kind,
        gel: &FastGel,
        variation: &SensorVariation,
        [n_environments, n_threads]: [usize; 2],
        autoreset: Autoreset,
    ) -> Result<Self, TaskError> {
        let most = most_sensors(gel.n_taxels());
        if n_environments == 0 || n_environments > most {
            return Err(TaskError::Count {
                found: n_environments,
                most,
            });
        }
        let batch = SensorBatch::new(gel, None, variation.clone(), [n_environments, n_threads], 0);
        let sensors = batch.into_parts();
        match kind {
            Kind::ExploreShape => Self::of(ExploreShape::on(gel)?, gel, sensors, autoreset),
            Kind::HoldForce => Self::of(HoldForce::on(gel)?, gel, sensors, autoreset),
            Kind::FollowEdge => Self::of(FollowEdge::on(gel)?, gel, sensors, autoreset),
        }
    }

    fn of<T: Task>(
        task: T,
        gel: &FastGel,
        sensors: Vec<SensorBatch>,
        autoreset: Autoreset,
    ) -> Result<Self, TaskError> {
        let task = Arc::new(task);
        let of_chunk = sensors.first().map_or(1, SensorBatch::n_sensors).max(1);
        let first_seeds = (0..).step_by(of_chunk);
        let chunks: Vec<Box<dyn Steps>> = sensors
            .into_iter()
            .zip(first_seeds)
            .map(|(sensors, first)| Box::new(Chunk::new(&task, sensors, first)) as Box<dyn Steps>)
            .collect();
        Ok(Self {
            n_environments: chunks.iter().map(|chunk| chunk.n_environments()).sum(),
            chunks,
            of_chunk,
            n_observed: task.n_observed(gel.n_taxels()),
            n_actions: T::N_ACTIONS,
            figures: T::FIGURES,
            autoreset,
            shown: Shown::of(gel)?,
        })
    }

    /// Number of environments.
    #[must_use]
    pub fn n_environments(&self) -> usize {
        self.n_environments
    }

    /// Length of an observation; each number is from -10 to 10.
    #[must_use]
    pub fn n_observed(&self) -> usize {
        self.n_observed
    }

    /// Length of an action; each number is from -1 to 1 and is clamped to this range.
    #[must_use]
    pub fn n_actions(&self) -> usize {
        self.n_actions
    }

    /// Names, with units, of the figures that are true in an environment and not observed.
    #[must_use]
    pub fn figures(&self) -> &'static [&'static str] {
        self.figures
    }

    /// Sets the seed of an environment: its next episode is the first one of this seed, whatever
    /// other environments there are.
    ///
    /// # Panics
    /// If there is no such environment.
    pub fn seed(&mut self, environment: usize, seed: u64) {
        self.chunks[environment / self.of_chunk].seed(environment % self.of_chunk, seed);
    }

    /// Begins the next episode of one environment.
    ///
    /// - `observed`, `figures`: outputs. `[n_observed]`, `[n_figures]`
    ///
    /// # Panics
    /// If there is no such environment, or if a slice has another length.
    pub fn reset(&mut self, environment: usize, observed: &mut [f32], figures: &mut [f32]) {
        assert_eq!(
            observed.len(),
            self.n_observed,
            "a number for each that is observed"
        );
        assert_eq!(figures.len(), self.figures.len(), "a number for each figure");
        self.chunks[environment / self.of_chunk].reset(environment % self.of_chunk, observed, figures);
    }

    /// One step of every environment. `actions`: `[n_environments * n_actions]`
    ///
    /// # Panics
    /// If a slice has another length, or if an action is NaN.
    pub fn step(&mut self, actions: &[f32], answers: Answers<'_>) {
        self.check(actions, &answers);
        if let [chunk] = self.chunks.as_mut_slice() {
            // A single thread does not need the thread pool.
            chunk.step(self.autoreset, actions, answers);
            return;
        }
        let (n, autoreset) = (self.of_chunk, self.autoreset);
        let (n_observed, n_figures) = (n * self.n_observed, n * self.figures.len());
        let ends = answers
            .terminated
            .par_chunks_mut(n)
            .zip(answers.truncated.par_chunks_mut(n));
        let observed = answers
            .observed
            .par_chunks_mut(n_observed)
            .zip(answers.figures.par_chunks_mut(n_figures));
        let last = answers
            .last_observed
            .par_chunks_mut(n_observed)
            .zip(answers.last_figures.par_chunks_mut(n_figures));
        let rewards = answers.rewards.par_chunks_mut(n);
        let pieces = rewards.zip(ends).zip(observed).zip(last);
        let work = self
            .chunks
            .par_iter_mut()
            .zip(actions.par_chunks(n * self.n_actions))
            .zip(pieces);
        work.for_each(|((chunk, actions), piece)| {
            let (((rewards, (terminated, truncated)), (observed, figures)), (last_observed, last_figures)) =
                piece;
            let answers = Answers {
                observed,
                rewards,
                terminated,
                truncated,
                figures,
                last_observed,
                last_figures,
            };
            chunk.step(autoreset, actions, answers);
        });
    }

    /// An environment from above, and its sensor's readings: red, green and blue of each pixel, row
    /// by row from the top, of the size [`PICTURE_PX`](crate::PICTURE_PX).
    ///
    /// # Errors
    /// A picture that cannot be made.
    ///
    /// # Panics
    /// If there is no such environment.
    pub fn picture(&self, environment: usize) -> Result<Vec<u8>, TaskError> {
        self.chunks[environment / self.of_chunk].picture(environment % self.of_chunk, &self.shown)
    }

    fn check(&self, actions: &[f32], answers: &Answers<'_>) {
        let (n, n_figures) = (self.n_environments, self.figures.len());
        assert_eq!(actions.len(), n * self.n_actions, "actions of each environment");
        assert!(
            actions.iter().all(|action| !action.is_nan()),
            "an action is not a number"
        );
        let given = [
            answers.observed.len(),
            answers.last_observed.len(),
            answers.figures.len(),
            answers.last_figures.len(),
            answers.rewards.len(),
            answers.terminated.len(),
            answers.truncated.len(),
        ];
        let observed = n * self.n_observed;
        let expected = [observed, observed, n * n_figures, n * n_figures, n, n, n];
        assert_eq!(given, expected, "answers of each environment");
    }
}
