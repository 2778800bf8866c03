//! The environments of one thread.

use std::sync::Arc;

use twintac_fast::Touch;
use twintac_sensors::SensorBatch;

use crate::TaskError;
use crate::answers::{Answers, Autoreset};
use crate::environment::{Environment, draw};
use crate::picture::{Shown, pixels};
use crate::task::{Felt, Task};

/// Environments of any task.
pub(crate) trait Steps: Send + Sync {
    fn n_environments(&self) -> usize;
    /// Sets the seed from which an environment draws its next episodes.
    fn seed(&mut self, environment: usize, seed: u64);
    /// Begins the next episode of an environment and observes it.
    fn reset(&mut self, environment: usize, observed: &mut [f32], figures: &mut [f32]);
    /// One step of every environment.
    fn step(&mut self, autoreset: Autoreset, actions: &[f32], answers: Answers<'_>);
    /// A picture of an environment.
    fn picture(&self, environment: usize, shown: &Shown) -> Result<Vec<u8>, TaskError>;
}

/// Environments of one task.
pub(crate) struct Chunk<T: Task> {
    task: Arc<T>,
    sensors: SensorBatch,
    n_taxels: usize,
    environments: Vec<Environment<T::Episode>>,
    touches: Vec<Touch>,
    ends: Vec<usize>,
    /// Readings, and readings of the step before, kPa. `[n_environments * n_taxels]`
    readings_kpa: Vec<f32>,
    before_kpa: Vec<f32>,
    wrench: Vec<[f32; 6]>,
}

impl<T: Task> Chunk<T> {
    /// As many environments as there are sensors; the first has this seed, the others the following
    /// numbers.
    pub(crate) fn new(task: &Arc<T>, sensors: SensorBatch, first_seed: u64) -> Self {
        let (n, n_taxels) = (sensors.n_sensors(), sensors.n_taxels());
        let mut chunk = Self {
            environments: (0..n as u64)
                .map(|number| Environment {
                    seed: first_seed.wrapping_add(number),
                    next: 0,
                    is_over: false,
                    episode: draw(task.as_ref(), n_taxels, first_seed.wrapping_add(number), 0).0,
                })
                .collect(),
            task: Arc::clone(task),
            sensors,
            n_taxels,
            touches: Vec::with_capacity(n),
            ends: Vec::with_capacity(n),
            readings_kpa: vec![0.0; n * n_taxels],
            before_kpa: vec![0.0; n * n_taxels],
            wrench: vec![[0.0; 6]; n],
        };
        for number in 0..n {
            chunk.begin(number);
        }
        chunk
    }

    /// Begins the next episode of an environment, with readings of zero.
    fn begin(&mut self, number: usize) {
        let sensor = self.environments[number].begin(self.task.as_ref(), self.n_taxels);
        self.sensors.replace(number, sensor);
        self.forget(number);
    }

    fn forget(&mut self, number: usize) {
        let own = number * self.n_taxels..(number + 1) * self.n_taxels;
        self.readings_kpa[own.clone()].fill(0.0);
        self.before_kpa[own].fill(0.0);
        self.wrench[number] = [0.0; 6];
    }

    fn felt(&self, number: usize) -> Felt<'_> {
        let own = number * self.n_taxels..(number + 1) * self.n_taxels;
        Felt {
            readings_kpa: &self.readings_kpa[own.clone()],
            before_kpa: &self.before_kpa[own],
            force_n: -f64::from(self.wrench[number][2]),
        }
    }

    /// Moves all robots, except those whose episode has ended and is begun anew in this step.
    fn act(&mut self, is_next_step: bool, actions: &[f32]) {
        let moves = self
            .environments
            .iter_mut()
            .zip(actions.chunks_exact(T::N_ACTIONS));
        for (environment, actions) in moves {
            if !(is_next_step && environment.is_over) {
                self.task.act(&mut environment.episode, actions);
            }
        }
    }

    /// Computes the readings of all frames of a step.
    fn read(&mut self) {
        self.before_kpa.copy_from_slice(&self.readings_kpa);
        self.touches.clear();
        self.ends.clear();
        for (number, environment) in self.environments.iter().enumerate() {
            self.touches.push(self.task.touch(&environment.episode));
            self.ends.push(self.touches.len());
            if T::RESTS {
                self.sensors.rest(number);
            }
        }
        let [first_s, others_s @ ..] = T::FRAMES_S else {
            return;
        };
        self.sensors.step(
            *first_s,
            self.task.bodies(),
            &self.touches,
            &self.ends,
            &mut self.readings_kpa,
            &mut self.wrench,
        );
        for since_previous_s in others_s {
            self.sensors.stay(*since_previous_s, &mut self.readings_kpa);
        }
    }

    fn observe(&self, number: usize, observed: &mut [f32], figures: &mut [f32]) {
        let episode = &self.environments[number].episode;
        self.task.observe(episode, &self.felt(number), observed);
        self.task.figures(episode, figures);
    }
}

impl<T: Task> Steps for Chunk<T> {
    fn n_environments(&self) -> usize {
        self.environments.len()
    }

    fn seed(&mut self, environment: usize, seed: u64) {
        self.environments[environment].seed = seed;
        self.environments[environment].next = 0;
    }

    fn reset(&mut self, environment: usize, observed: &mut [f32], figures: &mut [f32]) {
        self.begin(environment);
        self.observe(environment, observed, figures);
    }

    fn step(&mut self, autoreset: Autoreset, actions: &[f32], answers: Answers<'_>) {
        let is_next_step = autoreset == Autoreset::NextStep;
        self.act(is_next_step, actions);
        self.read();
        let n_observed = self.task.n_observed(self.n_taxels);
        let n_figures = T::FIGURES.len();
        for number in 0..self.environments.len() {
            let observed = &mut answers.observed[number * n_observed..][..n_observed];
            let figures = &mut answers.figures[number * n_figures..][..n_figures];
            if is_next_step && self.environments[number].is_over {
                self.begin(number);
                (
                    answers.rewards[number],
                    answers.terminated[number],
                    answers.truncated[number],
                ) = (0.0, false, false);
                self.observe(number, observed, figures);
                continue;
            }
            let own = number * self.n_taxels..(number + 1) * self.n_taxels;
            let felt = Felt {
                readings_kpa: &self.readings_kpa[own.clone()],
                before_kpa: &self.before_kpa[own],
                force_n: -f64::from(self.wrench[number][2]),
            };
            let outcome = self.task.feel(&mut self.environments[number].episode, &felt);
            answers.rewards[number] = outcome.reward;
            answers.terminated[number] = outcome.terminated;
            answers.truncated[number] = outcome.truncated;
            self.environments[number].is_over = outcome.terminated || outcome.truncated;
            self.observe(number, observed, figures);
            if autoreset == Autoreset::SameStep && self.environments[number].is_over {
                answers.last_observed[number * n_observed..][..n_observed].copy_from_slice(observed);
                answers.last_figures[number * n_figures..][..n_figures].copy_from_slice(figures);
                self.begin(number);
                self.observe(number, observed, figures);
            }
        }
    }

    fn picture(&self, environment: usize, shown: &Shown) -> Result<Vec<u8>, TaskError> {
        let look = self.task.look(&self.environments[environment].episode);
        pixels(&look, self.felt(environment).readings_kpa, shown)
    }
}
