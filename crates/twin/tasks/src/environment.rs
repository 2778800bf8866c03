//! One environment, and the sensors of several.

use twintac_fast::{Body, Touch};
use twintac_random::stream;
use twintac_sensors::SensorBatch;

use crate::task::Task;

/// Sensors of the environments of one thread: from what touches to what is read. Those of a [`SensorBatch`], or of a bench.
pub trait Sensors: Send + Sync {
    /// Number of sensors, and of the taxels of each.
    fn sizes(&self) -> [usize; 2];

    /// One more moment of every sensor, as [`SensorBatch::step`].
    fn step(
        &mut self,
        since_previous_s: f64,
        bodies: &[Body],
        touches: &[Touch],
        ends: &[usize],
        readings_kpa: &mut [f32],
        wrench: &mut [[f32; 6]],
    );

    /// Lets the gel of one sensor rest.
    fn rest(&mut self, sensor: usize);

    /// Puts the sensor of a number in the place of one.
    fn replace(&mut self, sensor: usize, number: u64);
}

impl Sensors for SensorBatch {
    fn sizes(&self) -> [usize; 2] {
        [self.n_sensors(), self.n_taxels()]
    }

    fn step(
        &mut self,
        since_previous_s: f64,
        bodies: &[Body],
        touches: &[Touch],
        ends: &[usize],
        readings_kpa: &mut [f32],
        wrench: &mut [[f32; 6]],
    ) {
        self.step(since_previous_s, bodies, touches, ends, readings_kpa, wrench);
    }

    fn rest(&mut self, sensor: usize) {
        self.rest(sensor);
    }

    fn replace(&mut self, sensor: usize, number: u64) {
        self.replace(sensor, number);
    }
}

/// One environment: its seed, which of its episodes it is in, and that.
#[derive(Clone, Debug)]
pub(crate) struct Environment<E> {
    pub(crate) seed: u64,
    /// Number of the next episode.
    pub(crate) next: u64,
    pub(crate) is_over: bool,
    pub(crate) episode: E,
}

impl<E> Environment<E> {
    /// Begins the next episode; returns the number of its sensor. An episode is the same under the same seed and number, whatever else there is.
    pub(crate) fn begin<T: Task<Episode = E>>(&mut self, task: &T, n_taxels: usize) -> u64 {
        let (episode, sensor) = draw(task, n_taxels, self.seed, self.next);
        self.episode = episode;
        self.next += 1;
        self.is_over = false;
        sensor
    }
}

/// An episode of a seed, and the number of its sensor.
pub(crate) fn draw<T: Task>(task: &T, n_taxels: usize, seed: u64, number: u64) -> (T::Episode, u64) {
    let mut random = stream(seed, &format!("episode {number}"));
    let sensor = rand::Rng::random(&mut random);
    (task.begin(n_taxels, &mut random), sensor)
}
