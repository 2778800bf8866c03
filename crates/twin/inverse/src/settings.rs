//! Settings of contact estimation.

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, Ranges};

/// Uncertainty of readings and forward model, and how fast a contact may change.
///
/// The variance of a reading `p` in a frame with the largest reading `m` is
/// `noise² + (model_part p)² + (model_part_of_largest m)²`. The noise of two frames is independent.
/// The error of the model is not: frames within `correlated_s` count as one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct InverseSettings {
    /// Standard deviation of a reading's noise, kPa.
    pub noise_kpa: f64,
    /// Standard deviation of the model's error as a fraction of each reading.
    pub model_part: f64,
    /// Standard deviation of the model's error as a fraction of the frame's largest reading.
    pub model_part_of_largest: f64,
    /// Standard deviation of the model's error of the force, as a fraction of the force.
    pub force_part: f64,
    /// Time within which errors of the model count as one, s.
    pub correlated_s: f64,
    /// There is a contact if at least one reading is this many standard deviations of the noise
    /// above zero.
    pub touch_deviations: f64,
    /// Standard deviation of the random motion of a contact along x and along y in one second, mm;
    /// it grows with the square root of time.
    pub place_walk_mm: f64,
    /// Standard deviation of the random change of depth in one second, mm.
    pub depth_walk_mm: f64,
    /// Standard deviation of the random change of yaw in one second, radians.
    pub yaw_walk_rad: f64,
    /// Time after which evidence for a shape is reduced to 1/e, s.
    pub shape_memory_s: f64,
    /// Number of possible presses of each shape that are followed at once, at most 100.
    pub n_starts: usize,
    /// Number of steps that each of them takes in a frame, at most 100.
    pub n_steps: usize,
    /// Largest depth that is considered, mm below first touch, at most 50. For a surrogate
    /// (`FastGel`): not deeper than it was trained.
    pub deepest_mm: f64,
}

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
            yaw_walk_rad: 1.0,
            shape_memory_s: 3.0,
            n_starts: 3,
            n_steps: 1,
            deepest_mm: 5.0,
        }
    }
}

impl Checked for InverseSettings {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            noise_kpa,
            model_part,
            model_part_of_largest,
            force_part,
            correlated_s,
            touch_deviations,
            place_walk_mm,
            depth_walk_mm,
            yaw_walk_rad,
            shape_memory_s,
            n_starts,
            n_steps,
            deepest_mm,
        } = *self;
        ranges.number("noise_kpa", noise_kpa, 1e-9..=1e6);
        ranges.zero_or("model_part", model_part, 1e-9..=10.0);
        ranges.zero_or("model_part_of_largest", model_part_of_largest, 1e-9..=10.0);
        ranges.zero_or("force_part", force_part, 1e-9..=10.0);
        ranges.number("correlated_s", correlated_s, 1e-6..=1e6);
        ranges.number("touch_deviations", touch_deviations, 1e-3..=1e6);
        ranges.zero_or("place_walk_mm", place_walk_mm, 1e-9..=1e4);
        ranges.zero_or("depth_walk_mm", depth_walk_mm, 1e-9..=1e4);
        ranges.zero_or("yaw_walk_rad", yaw_walk_rad, 1e-9..=1e4);
        ranges.number("shape_memory_s", shape_memory_s, 1e-3..=1e6);
        ranges.number("n_starts", n_starts, 1.0..=100.0);
        ranges.number("n_steps", n_steps, 1.0..=100.0);
        ranges.number("deepest_mm", deepest_mm, 0.01..=50.0);
    }
}
