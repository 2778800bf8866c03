//! Frame rate and its jitter.

use serde::Serialize;
use twintac_recording::{Frames, Recording};

use crate::Finding;
use crate::statistics::{deviation, mean, median};

/// An interval longer than this many medians is a gap with missing frames.
const GAP: f64 = 1.5;

/// Smallest number of intervals.
const FEWEST: usize = 20;

/// Frame rate, from the recordings' time stamps.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrameTiming {
    /// Frame rate: one over the mean interval between neighbouring frames, Hz.
    pub rate_hz: f64,
    /// Standard deviation of the interval, as a fraction of its mean.
    pub jitter: f64,
    /// Number of intervals it was found from.
    pub n_intervals: usize,
    /// Number of intervals longer than 1.5 times the median; they are left out.
    pub n_gaps: usize,
}

/// From the presses. Without presses, from the logs.
pub(crate) fn timing(recording: &Recording, logs: &[Frames]) -> Finding<FrameTiming> {
    let logs = logs.iter().filter(|_| recording.presses.is_empty());
    let courses = recording.presses.iter().map(|press| &press.time_s);
    let all_s: Vec<f64> = courses
        .chain(logs.map(|frames| &frames.time_s))
        .flat_map(|time_s| time_s.windows(2).map(|pair| pair[1] - pair[0]))
        .collect();
    let usual_s = median(&all_s).unwrap_or(0.0);
    let neighbours_s: Vec<f64> = all_s
        .iter()
        .copied()
        .filter(|interval_s| *interval_s <= GAP * usual_s)
        .collect();
    match (mean(&neighbours_s), deviation(&neighbours_s)) {
        (Some(mean_s), Some(deviation_s)) if neighbours_s.len() >= FEWEST => Finding::Found(FrameTiming {
            rate_hz: 1.0 / mean_s,
            jitter: deviation_s / mean_s,
            n_intervals: neighbours_s.len(),
            n_gaps: all_s.len() - neighbours_s.len(),
        }),
        _ => Finding::NotGiven(format!(
            "there are {} intervals between frames, at least {FEWEST} are required",
            all_s.len()
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, noise, press, recording};

    #[test]
    fn a_known_rate_and_jitter_are_found_beside_a_gap() {
        let mut shaken = press(&Shape {
            loading_s: 20.0,
            ..Shape::default()
        });
        let mut time_s = 0.0;
        for (frame, stamp_s) in shaken.time_s.iter_mut().enumerate() {
            time_s += 0.02 * (1.0 + 0.05 * noise(0.0, frame)) + if frame == 500 { 0.2 } else { 0.0 };
            *stamp_s = time_s;
        }
        let finding = timing(&recording(vec![shaken]), &[]);
        let found = finding.found().unwrap();
        assert!((found.rate_hz - 50.0).abs() < 0.1, "{found:?}");
        assert!((found.jitter - 0.05).abs() < 0.001, "{found:?}");
        assert_eq!(found.n_gaps, 1);
        let few = press(&Shape {
            rate_hz: 2.0,
            ..Shape::default()
        });
        assert!(timing(&recording(vec![few]), &[]).why_not().is_some());
    }
}
