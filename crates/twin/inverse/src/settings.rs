//! What the inverse assumes.

use serde::{Deserialize, Serialize};

use crate::error::InverseError;

/// How sure readings and model are, and how fast a contact changes.
///
/// The variance of a reading `p` in a frame, where `m` is the largest reading: `noise² + (model_part p)² + (model_part_of_largest m)²`. The noise
/// of two frames is independent. The error of the model is not: frames within `correlated_s` count as one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct InverseSettings {
    /// Standard deviation of a reading's noise, kPa.
    pub noise_kpa: f64,
    /// Standard deviation of the model's error as part of each reading.
    pub model_part: f64,
    /// The same as part of the frame's largest reading.
    pub model_part_of_largest: f64,
    /// The same of the force, as part of it.
    pub force_part: f64,
    /// Time within which errors of the model count as one, s.
    pub correlated_s: f64,
    /// A contact is what reads so many deviations of the noise, at one taxel at least.
    pub touch_deviations: f64,
    /// Standard deviation of how far a contact wanders along x and along y in a second, mm; it grows with the root of time.
    pub place_walk_mm: f64,
    /// The same of the depth, mm.
    pub depth_walk_mm: f64,
    /// The same of the spin, radians.
    pub spin_walk_rad: f64,
    /// Time after which what told the shape is forgotten to a part of 1/e, s.
    pub shape_memory_s: f64,
    /// Possible presses of each shape that are followed at once, at most 100.
    pub n_starts: usize,
    /// Steps towards the best press of each of them in a frame, at most 100.
    pub n_steps: usize,
    /// Deepest press that is thought of, mm below first touch, at most 100. For a fast gel: not deeper than it was taught.
    pub deepest_mm: f64,
}

/// Largest of the settings that time and memory grow with.
const MOST: f64 = 100.0;

impl Default for InverseSettings {
    fn default() -> Self {
        Self {
            noise_kpa: 0.05,
            model_part: 0.03,
            model_part_of_largest: 0.01,
            force_part: 0.03,
            correlated_s: 0.1,
            touch_deviations: 6.0,
            place_walk_mm: 3.0,
            depth_walk_mm: 2.0,
            spin_walk_rad: 1.0,
            shape_memory_s: 3.0,
            n_starts: 3,
            n_steps: 1,
            deepest_mm: 5.0,
        }
    }
}

impl InverseSettings {
    /// Whether these settings can be.
    ///
    /// # Errors
    /// [`InverseError::Setting`], which names the first that is not finite, below zero, zero where that has no meaning, or larger than it may be.
    pub fn check(&self) -> Result<(), InverseError> {
        let above_zero = [
            ("noise_kpa", self.noise_kpa),
            ("correlated_s", self.correlated_s),
            ("shape_memory_s", self.shape_memory_s),
            ("touch_deviations", self.touch_deviations),
        ];
        let bounded = [
            ("deepest_mm", self.deepest_mm),
            ("n_starts", self.n_starts as f64),
            ("n_steps", self.n_steps as f64),
        ];
        let from_zero_on = [
            ("model_part", self.model_part),
            ("model_part_of_largest", self.model_part_of_largest),
            ("force_part", self.force_part),
            ("place_walk_mm", self.place_walk_mm),
            ("depth_walk_mm", self.depth_walk_mm),
            ("spin_walk_rad", self.spin_walk_rad),
        ];
        let refuse = |(field, found), expected| InverseError::Setting {
            field,
            found,
            expected,
        };
        let is_wrong = |number: &f64| !number.is_finite() || *number < 0.0;
        let no_positive = above_zero
            .into_iter()
            .find(|(_, number)| is_wrong(number) || *number == 0.0);
        let negative = from_zero_on.into_iter().find(|(_, number)| is_wrong(number));
        let unbounded = bounded
            .into_iter()
            .find(|(_, number)| !(*number > 0.0 && *number <= MOST));
        let refused = no_positive
            .map(|setting| refuse(setting, "a number above 0"))
            .or(negative.map(|setting| refuse(setting, "0 or a number above it")))
            .or(unbounded.map(|setting| refuse(setting, "a number above 0, and at most 100")));
        refused.map_or(Ok(()), Err)
    }
}
