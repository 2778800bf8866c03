//! What a task has to say about one environment.

use glam::DVec2;
use twintac_fast::{Body, Touch};
use twintac_random::RandomStream;

/// Frames that a sensor delivers in a second, Hz: PhysTac's.
pub(crate) const RATE_HZ: f64 = 55.0;

/// Readings are observed in this unit, kPa, and what they changed by since the last frame in the other.
pub(crate) const READING_UNIT_KPA: f32 = 10.0;
pub(crate) const CHANGE_UNIT_KPA: f32 = 1.0;

/// Largest value of an observation.
pub(crate) const LARGEST_OBSERVED: f32 = 10.0;

/// A task: what happens in one environment, from the beginning of an episode to its end.
pub(crate) trait Task: Send + Sync + 'static {
    /// What is true in an environment.
    type Episode: Clone + Send + Sync;
    /// Numbers of an action, each from -1 to 1.
    const N_ACTIONS: usize;
    /// Names of what is told about an environment beside the observation, with units.
    const FIGURES: &'static [&'static str];
    /// Times from frame to frame of one step, s. Of the last one, readings are seen.
    const FRAMES_S: &'static [f64];
    /// Whether the gel rests before each step.
    const RESTS: bool;

    /// What may touch the sensor.
    fn bodies(&self) -> &[Body];
    /// Numbers of an observation.
    fn n_observed(&self, n_taxels: usize) -> usize;
    /// Begins an episode; nothing is touched yet.
    fn begin(&self, n_taxels: usize, random: &mut RandomStream) -> Self::Episode;
    /// Moves the robot.
    fn act(&self, episode: &mut Self::Episode, actions: &[f32]);
    /// What touches the sensor now.
    fn touch(&self, episode: &Self::Episode) -> Touch;
    /// What comes of it, by what the sensor reads and the force on the gel.
    fn feel(&self, episode: &mut Self::Episode, felt: &Felt<'_>) -> Outcome;
    /// What the robot knows. `[n_observed]`
    fn observe(&self, episode: &Self::Episode, felt: &Felt<'_>, observed: &mut [f32]);
    /// What is told beside it. `[FIGURES]`
    fn figures(&self, episode: &Self::Episode, figures: &mut [f32]);
    /// What a picture shows.
    fn look(&self, episode: &Self::Episode) -> Look;
}

/// What a sensor feels.
#[derive(Clone, Copy)]
pub(crate) struct Felt<'a> {
    /// What it reads, and what it read a step before, kPa. `[n_taxels]`
    pub(crate) readings_kpa: &'a [f32],
    pub(crate) before_kpa: &'a [f32],
    /// The force with which it is pressed, N.
    pub(crate) force_n: f64,
}

/// How a step ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) reward: f64,
    /// The task is over.
    pub(crate) terminated: bool,
    /// Time is over.
    pub(crate) truncated: bool,
}

/// What a picture shows, in the gel's frame.
pub(crate) struct Look {
    /// Outlines of what touches, mm.
    pub(crate) outlines_mm: Vec<Vec<DVec2>>,
    /// Where the robot has been, mm.
    pub(crate) places_mm: Vec<DVec2>,
    /// Lines of text.
    pub(crate) lines: Vec<String>,
}

impl Felt<'_> {
    /// Readings and their changes, in their units. `[2 * n_taxels]`
    pub(crate) fn observe(&self, observed: &mut [f32]) {
        let (readings, changes) = observed.split_at_mut(self.readings_kpa.len());
        for (taxel, reading_kpa) in self.readings_kpa.iter().enumerate() {
            readings[taxel] = limited(reading_kpa / READING_UNIT_KPA);
            changes[taxel] = limited((reading_kpa - self.before_kpa[taxel]) / CHANGE_UNIT_KPA);
        }
    }
}

/// Within what an observation may be.
pub(crate) fn limited(value: f32) -> f32 {
    value.clamp(-LARGEST_OBSERVED, LARGEST_OBSERVED)
}

/// A part of what a robot can do, from -1 to 1.
pub(crate) fn part(action: f32) -> f64 {
    f64::from(action.clamp(-1.0, 1.0))
}
