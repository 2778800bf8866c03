//! One environment.

use twintac_random::stream;

use crate::task::Task;

/// One environment: its seed and its current episode.
#[derive(Clone, Debug)]
pub(crate) struct Environment<E> {
    pub(crate) seed: u64,
    /// Number of the next episode.
    pub(crate) next: u64,
    pub(crate) is_over: bool,
    pub(crate) episode: E,
}

impl<E> Environment<E> {
    /// Begins the next episode; returns the number of its sensor. The same seed and number give the
    /// same episode.
    pub(crate) fn begin<T: Task<Episode = E>>(&mut self, task: &T, n_taxels: usize) -> u64 {
        let (episode, sensor) = draw(task, n_taxels, self.seed, self.next);
        self.episode = episode;
        self.next += 1;
        self.is_over = false;
        sensor
    }
}

/// The episode of a seed and a number, and the number of its sensor.
pub(crate) fn draw<T: Task>(task: &T, n_taxels: usize, seed: u64, number: u64) -> (T::Episode, u64) {
    let mut random = stream(seed, &format!("episode {number}"));
    let sensor = rand::Rng::random(&mut random);
    (task.begin(n_taxels, &mut random), sensor)
}
