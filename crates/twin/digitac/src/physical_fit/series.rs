//! Frames of presses in the order in which they happened, as input of a fit of barometers.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::Features;

/// Frames whose largest reading is below this fraction of the file's largest do not count as
/// contact.
const CONTACT_FRACTION: f64 = 0.03;
/// Weight of the nearest taxel of a frame in contact, relative to any other reading.
const NEAREST_WEIGHT: f64 = 3.0;

/// A press of a fit. `is_used` says whether its readings are fitted. The readings of other presses
/// are not used, but their relaxation is taken into account.
pub(crate) struct Fitted<'a> {
    pub(crate) mounting: &'a str,
    pub(crate) features: &'a Features,
    pub(crate) readings_kpa: &'a [Vec<f64>],
    pub(crate) valid: &'a [Vec<bool>],
    pub(crate) is_used: bool,
}

/// Frames of presses, one press after another.
pub(crate) struct Series {
    /// Time since the previous frame, s; `None` if the gel had rested; `[n_frames]`.
    pub(crate) since_s: Vec<Option<f64>>,
    /// Frames of each press.
    pub(crate) presses: Vec<Range<usize>>,
    /// Frames of each press over which readings were set to zero.
    pub(crate) zeros: Vec<Range<usize>>,
    /// Frames of each installation, whose presses are next to each other.
    pub(crate) mountings: BTreeMap<String, Range<usize>>,
    /// Measured readings, kPa; `[n_taxels][n_frames]`.
    pub(crate) readings_kpa: Vec<Vec<f64>>,
    /// Weight of each reading, over the largest reading of its installation;
    /// `[n_taxels][n_frames]`.
    pub(crate) weights: Vec<Vec<f64>>,
    /// Inverse of the largest reading of the frame's installation; `[n_frames]`.
    pub(crate) per_kpa: Vec<f64>,
}

impl Series {
    /// Presses of one installation must be next to each other, in the order of time. Weights add up
    /// to one over all taxels that are not excluded.
    pub(crate) fn new(presses: &[Fitted<'_>], n_taxels: usize, left_out: &BTreeSet<usize>) -> Self {
        let mut series = Self {
            since_s: Vec::new(),
            presses: Vec::new(),
            zeros: Vec::new(),
            mountings: BTreeMap::new(),
            readings_kpa: vec![Vec::new(); n_taxels],
            weights: vec![Vec::new(); n_taxels],
            per_kpa: Vec::new(),
        };
        let largest_kpa = largest_by_mounting(presses, left_out);
        for press in presses {
            let start = series.since_s.len();
            let time_s = &press.features.time_s;
            let range = series
                .mountings
                .entry(press.mounting.to_owned())
                .or_insert(start..start);
            let follows = range.end == start && start > range.start;
            range.end = start + time_s.len();
            let largest_kpa = largest_kpa.get(press.mounting).copied().unwrap_or(0.0);
            for frame in 0..time_s.len() {
                series.since_s.push(match frame {
                    0 if follows => press.features.since_previous_s,
                    0 => None,
                    _ => Some(time_s[frame] - time_s[frame - 1]),
                });
                series.per_kpa.push(if largest_kpa > 0.0 {
                    largest_kpa.recip()
                } else {
                    0.0
                });
                let row = press.readings_kpa[frame]
                    .iter()
                    .zip(&press.valid[frame])
                    .enumerate();
                let counted = row
                    .clone()
                    .filter(|(k, (_, valid))| **valid && !left_out.contains(k));
                let nearest = counted
                    .max_by(|a, b| a.1.0.total_cmp(b.1.0))
                    .map(|(k, (reading, _))| (k, *reading));
                for (k, (reading, valid)) in row {
                    let is_nearest = nearest.is_some_and(|(nearest, reading)| {
                        nearest == k
                            && reading > CONTACT_FRACTION * largest_kpa
                            && press.features.depth_mm[frame] > 0.0
                    });
                    let counts = press.is_used && *valid && largest_kpa > 0.0;
                    let weight = if is_nearest { NEAREST_WEIGHT } else { 1.0 };
                    series.weights[k].push(if counts { weight } else { 0.0 });
                    series.readings_kpa[k].push(if counts { *reading } else { 0.0 });
                }
            }
            let zero = &press.features.zero_frames;
            series.zeros.push(start + zero.start..start + zero.end);
            series.presses.push(start..start + time_s.len());
        }
        let kept = (0..n_taxels).filter(|k| !left_out.contains(k));
        let total: f64 = kept.map(|k| series.weights[k].iter().sum::<f64>()).sum();
        if total > 0.0 {
            series
                .weights
                .iter_mut()
                .flatten()
                .for_each(|weight| *weight /= total);
        }
        series
    }

    pub(crate) fn n_frames(&self) -> usize {
        self.since_s.len()
    }

    /// Subtracts from each press the mean over its zero frames. `values` belong to the frames of
    /// `range`, which covers whole presses.
    pub(crate) fn set_to_zero(&self, range: &Range<usize>, values: &mut [f64]) {
        let first = self.presses.partition_point(|press| press.start < range.start);
        for (press, zero) in self.presses[first..].iter().zip(&self.zeros[first..]) {
            if press.start >= range.end {
                break;
            }
            if zero.is_empty() {
                continue;
            }
            let mean = values[zero.start - range.start..zero.end - range.start]
                .iter()
                .sum::<f64>()
                / zero.len() as f64;
            let own = &mut values[press.start - range.start..press.end - range.start];
            own.iter_mut().for_each(|value| *value -= mean);
        }
    }
}

/// Largest usable reading of the presses that are used, by installation.
fn largest_by_mounting<'a>(presses: &'a [Fitted<'_>], left_out: &BTreeSet<usize>) -> BTreeMap<&'a str, f64> {
    let mut largest_kpa: BTreeMap<&str, f64> = BTreeMap::new();
    for press in presses.iter().filter(|press| press.is_used) {
        let largest = largest_kpa.entry(press.mounting).or_insert(0.0);
        for (row, valid) in press.readings_kpa.iter().zip(press.valid) {
            for (k, (reading, valid)) in row.iter().zip(valid).enumerate() {
                if *valid && !left_out.contains(&k) {
                    *largest = largest.max(*reading);
                }
            }
        }
    }
    largest_kpa
}
