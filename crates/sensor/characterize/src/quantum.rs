//! Resolution: the smallest step between readings.
//!
//! Quantized readings of a press differ by multiples of one step. The step is the smallest
//! difference between neighbours in order of size, if nearly all other differences between
//! neighbours are multiples of it.

use serde::Serialize;
use twintac_recording::{Frames, Recording};

use crate::Finding;

/// Differences below this are rounding errors, kPa.
const ROUNDING_KPA: f64 = 1e-9;

/// Largest difference that is used, in steps. For larger ones one cannot tell whether they are
/// multiples.
const MOST_STEPS: f64 = 100.0;

/// Largest deviation of a difference from a multiple, in steps.
const OFF_STEPS: f64 = 0.05;

/// Fraction of the differences that have to be multiples.
const MOST: f64 = 0.99;

/// Smallest number of differences.
const FEWEST: usize = 20;

/// The resolution of the readings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantum {
    /// The smallest step between readings, kPa.
    pub step_kpa: f64,
    /// Number of differences it was found from.
    pub n_differences: usize,
}

/// From the presses. Without presses, from the logs.
pub(crate) fn quantum(recording: &Recording, logs: &[Frames]) -> Finding<Quantum> {
    let mut differences_kpa = Vec::new();
    let mut add = |mut readings_kpa: Vec<f64>| {
        readings_kpa.sort_by(f64::total_cmp);
        let steps = readings_kpa.windows(2).map(|pair| pair[1] - pair[0]);
        differences_kpa.extend(steps.filter(|step_kpa| *step_kpa > ROUNDING_KPA));
    };
    for taxel in 0..recording.taxels.len() {
        for press in &recording.presses {
            let valid = press.taxels_kpa.iter().zip(&press.valid);
            let valid = valid.filter(|(_, valid)| valid[taxel]);
            add(valid.map(|(readings_kpa, _)| readings_kpa[taxel]).collect());
        }
        for log in logs.iter().filter(|_| recording.presses.is_empty()) {
            let readings_kpa = log.readings_kpa.iter().map(|row| row[taxel]);
            add(readings_kpa.filter(|kpa| !kpa.is_nan()).collect());
        }
    }
    let step_kpa = differences_kpa.iter().copied().fold(f64::INFINITY, f64::min);
    let near: Vec<f64> = differences_kpa
        .iter()
        .map(|difference_kpa| difference_kpa / step_kpa)
        .filter(|steps| *steps <= MOST_STEPS)
        .collect();
    let n_multiples = near
        .iter()
        .filter(|steps| (*steps - steps.round()).abs() < OFF_STEPS)
        .count();
    if near.len() < FEWEST || (n_multiples as f64) < MOST * near.len() as f64 {
        return Finding::NotGiven("readings are not multiples of one step".to_owned());
    }
    Finding::Found(Quantum {
        step_kpa,
        n_differences: near.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, press, recording};

    #[test]
    fn a_known_step_is_found_and_readings_without_steps_have_none() {
        let smooth = press(&Shape {
            noise_kpa: 0.02,
            ..Shape::default()
        });
        let mut stepped = smooth.clone();
        for reading_kpa in stepped.taxels_kpa.iter_mut().flatten() {
            *reading_kpa = 0.01 * (*reading_kpa / 0.01).round() - 0.0037;
        }
        let finding = quantum(&recording(vec![stepped]), &[]);
        assert!(
            (finding.found().unwrap().step_kpa - 0.01).abs() < 1e-9,
            "{finding:?}"
        );
        assert!(quantum(&recording(vec![smooth]), &[]).why_not().is_some());
    }
}
