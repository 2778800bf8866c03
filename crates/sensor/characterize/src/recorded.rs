//! Presses with a known force, their phases, and the taxel that each presses.

use std::ops::Range;

use twintac_recording::{Control, Press, Recording};
use twintac_sensor::Sensor;

use crate::CharacterizeOptions;
use crate::phases::{Phases, duration_s};

/// A press with a known force.
pub(crate) struct Recorded<'a> {
    pub(crate) press: &'a Press,
    pub(crate) phases: Phases,
    /// The taxel under the indenter, if there is one.
    pub(crate) taxel: Option<usize>,
}

impl<'a> Recorded<'a> {
    pub(crate) fn of(press: &'a Press, sensor: &Sensor, above_mm: f64) -> Option<Self> {
        let phases = Phases::of(press)?;
        let place_mm = press.gel_from_indenter[phases.hold.start].position_mm.truncate();
        let distance_mm = |taxel: usize| sensor.taxels[taxel].position_mm.truncate().distance(place_mm);
        let nearest = (0..sensor.taxels.len()).min_by(|&a, &b| distance_mm(a).total_cmp(&distance_mm(b)));
        Some(Self {
            press,
            phases,
            taxel: nearest.filter(|&taxel| distance_mm(taxel) <= above_mm),
        })
    }

    pub(crate) fn all(recording: &'a Recording, sensor: &Sensor, options: &CharacterizeOptions) -> Vec<Self> {
        let presses = recording.presses.iter();
        presses
            .filter_map(|press| Self::of(press, sensor, options.above_mm))
            .collect()
    }

    /// Whether this is a slow press to a depth.
    pub(crate) fn is_slow(&self, options: &CharacterizeOptions) -> bool {
        self.press.control == Control::Pose && duration_s(self.press, &self.phases.loading) >= options.slow_s
    }

    pub(crate) fn hold_s(&self) -> f64 {
        duration_s(self.press, &self.phases.hold)
    }

    /// Force, N.
    pub(crate) fn force_n(&self, frame: usize) -> f64 {
        self.press.force_n.as_ref().map_or(0.0, |force_n| force_n[frame])
    }

    /// Largest force during loading and hold, N.
    pub(crate) fn peak_n(&self) -> f64 {
        (self.phases.loading.start..self.phases.hold.end)
            .map(|frame| self.force_n(frame))
            .fold(0.0, f64::max)
    }

    /// A taxel's valid readings in a range of frames, kPa.
    pub(crate) fn readings_kpa(&self, taxel: usize, frames: &Range<usize>) -> Vec<f64> {
        let valid = frames.clone().filter(|&frame| self.press.valid[frame][taxel]);
        valid.map(|frame| self.press.taxels_kpa[frame][taxel]).collect()
    }

    /// Force, N, and a taxel's reading, kPa, in the frames of a range where the reading is valid.
    pub(crate) fn points(&self, taxel: usize, frames: &Range<usize>) -> Vec<[f64; 2]> {
        let valid = frames.clone().filter(|&frame| self.press.valid[frame][taxel]);
        valid
            .map(|frame| [self.force_n(frame), self.press.taxels_kpa[frame][taxel]])
            .collect()
    }

    /// Frames from contact to the first frame of the hold.
    pub(crate) fn up(&self) -> Range<usize> {
        self.phases.loading.start..self.phases.hold.start + 1
    }

    /// Frames from the last frame of the hold to the loss of contact.
    pub(crate) fn down(&self) -> Range<usize> {
        self.phases.hold.end - 1..self.phases.unloading.end
    }
}

/// The presses above a taxel.
pub(crate) fn above<'r, 'a>(
    recorded: &'r [Recorded<'a>],
    taxel: usize,
) -> impl Iterator<Item = &'r Recorded<'a>> {
    recorded
        .iter()
        .filter(move |recorded| recorded.taxel == Some(taxel))
}
