//! What a task defines for one environment.

use glam::DVec2;
use twintac_fast::{Body, Touch};
use twintac_random::RandomStream;

/// Frame rate of a sensor, Hz: PhysTac's.
pub(crate) const RATE_HZ: f64 = 55.0;

/// Units of observed readings, and of their changes since the last frame, kPa.
pub(crate) const READING_UNIT_KPA: f32 = 10.0;
pub(crate) const CHANGE_UNIT_KPA: f32 = 1.0;

/// Largest absolute value of an observation.
pub(crate) const LARGEST_OBSERVED: f32 = 10.0;

/// A task: the events in one environment, from the start of an episode to its end.
pub(crate) trait Task: Send + Sync + 'static {
    /// The hidden state of an environment.
    type Episode: Clone + Send + Sync;
    /// Length of an action; each number is from -1 to 1.
    const N_ACTIONS: usize;
    /// Names, with units, of the figures that are returned beside the observation.
    const FIGURES: &'static [&'static str];
    /// Times from frame to frame of one step, s. The readings of the last frame are observed.
    const FRAMES_S: &'static [f64];
    /// Whether the gel is set to rest before each step.
    const RESTS: bool;

    /// The bodies that may touch the sensor.
    fn bodies(&self) -> &[Body];
    /// Length of an observation.
    fn n_observed(&self, n_taxels: usize) -> usize;
    /// Begins an episode, without contact.
    fn begin(&self, n_taxels: usize, random: &mut RandomStream) -> Self::Episode;
    /// Moves the robot.
    fn act(&self, episode: &mut Self::Episode, actions: &[f32]);
    /// The body at the sensor, and its pose.
    fn touch(&self, episode: &Self::Episode) -> Touch;
    /// The outcome of a step, from the sensor's readings and the force on the gel.
    fn feel(&self, episode: &mut Self::Episode, felt: &Felt<'_>) -> Outcome;
    /// Writes the observation. `[n_observed]`
    fn observe(&self, episode: &Self::Episode, felt: &Felt<'_>, observed: &mut [f32]);
    /// Writes the figures beside it. `[FIGURES]`
    fn figures(&self, episode: &Self::Episode, figures: &mut [f32]);
    /// Contents of a picture.
    fn look(&self, episode: &Self::Episode) -> Look;
}

/// Readings of a sensor, and the force on its gel.
#[derive(Clone, Copy)]
pub(crate) struct Felt<'a> {
    /// Readings, and readings of the step before, kPa. `[n_taxels]`
    pub(crate) readings_kpa: &'a [f32],
    pub(crate) before_kpa: &'a [f32],
    /// The force on the gel, N, positive in compression.
    pub(crate) force_n: f64,
}

/// The outcome of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) reward: f64,
    /// The task has ended.
    pub(crate) terminated: bool,
    /// The time limit has been reached.
    pub(crate) truncated: bool,
}

/// Contents of a picture, in the gel's frame.
pub(crate) struct Look {
    /// Outlines of the body, mm.
    pub(crate) outlines_mm: Vec<Vec<DVec2>>,
    /// Locations that the robot has pressed or is at, mm.
    pub(crate) places_mm: Vec<DVec2>,
    /// Lines of text.
    pub(crate) lines: Vec<String>,
}

impl Felt<'_> {
    /// Readings and their changes, in units of observations. `[2 * n_taxels]`
    pub(crate) fn observe(&self, observed: &mut [f32]) {
        let (readings, changes) = observed.split_at_mut(self.readings_kpa.len());
        for (taxel, reading_kpa) in self.readings_kpa.iter().enumerate() {
            readings[taxel] = limited(reading_kpa / READING_UNIT_KPA);
            changes[taxel] = limited((reading_kpa - self.before_kpa[taxel]) / CHANGE_UNIT_KPA);
        }
    }
}

/// A value, clamped to the range of observations.
pub(crate) fn limited(value: f32) -> f32 {
    value.clamp(-LARGEST_OBSERVED, LARGEST_OBSERVED)
}

/// An action, clamped to -1 to 1.
pub(crate) fn part(action: f32) -> f64 {
    f64::from(action.clamp(-1.0, 1.0))
}
