//! Condition of each taxel: dead, stuck, late or intermittent.
//!
//! - Dead: in most frames its reading cannot be used, or its raw reading is always zero.
//! - Stuck: its raw reading never changes.
//! - Late: its changes from frame to frame fit the changes of the other taxels one frame earlier at
//!   least twice as well as those of the same frame, in most presses that allow the comparison. A
//!   fit is measured by the sum of squares that remains after a common factor. A press allows the
//!   comparison if one of the two fits is at least twice as good as the other.
//! - Intermittent: it gives no reading in some frames.
//!
//! Frames in which a taxel gives no reading are ignored for "stuck".

use serde::Serialize;
use twintac_recording::{Frames, Press, Recording};

/// Smallest number of frames, in a press, for judging whether a taxel is late, and in all presses,
/// whether it is stuck.
const FEWEST: usize = 10;

/// Ratio by which one of the two fits has to be better.
const BETTER: f64 = 2.0;

/// The state of a taxel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Fate {
    /// It works.
    Fine,
    /// In most frames its reading cannot be used, or its raw reading is always zero.
    Dead,
    /// Its reading never changes.
    Stuck,
    /// Its readings come one frame late.
    Late,
    /// It gives no reading in some frames.
    Intermittent,
}

/// The condition of a taxel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Condition {
    /// The taxel's name.
    pub taxel: String,
    /// Its state.
    pub fate: Fate,
    /// Number of frames.
    pub n_frames: usize,
    /// Number of frames whose reading can be used.
    pub n_valid: usize,
    /// Number of frames without a reading.
    pub n_missing: usize,
    /// Number of presses that show whether it is late.
    pub n_timed: usize,
}

/// From the presses. Without presses from the logs, which do not show whether a taxel is late.
pub(crate) fn conditions(recording: &Recording, logs: &[Frames]) -> Vec<Condition> {
    let taxels = recording.taxels.iter().enumerate();
    taxels
        .map(|(taxel, name)| {
            let frames = recording
                .presses
                .iter()
                .flat_map(|press| press.valid.iter().zip(&press.taxels_raw));
            let (mut n_frames, mut n_valid, mut given) = (0, 0, Vec::new());
            for (valid, raw) in frames {
                n_frames += 1;
                n_valid += usize::from(valid[taxel]);
                given.extend(Some(raw[taxel]).filter(|raw| !raw.is_nan()));
            }
            let logs = logs.iter().filter(|_| recording.presses.is_empty());
            for row in logs.flat_map(|log| &log.readings_kpa) {
                n_frames += 1;
                n_valid += usize::from(!row[taxel].is_nan());
                given.extend(Some(row[taxel]).filter(|kpa| !kpa.is_nan()));
            }
            let n_missing = n_frames - given.len();
            let lags: Vec<bool> = recording
                .presses
                .iter()
                .filter_map(|press| lags(press, taxel))
                .collect();
            let n_late = lags.iter().filter(|lags| **lags).count();
            let never_changes = given.len() >= FEWEST && given.iter().all(|raw| *raw == given[0]);
            let fate = match () {
                () if never_changes && given[0] != 0.0 => Fate::Stuck,
                () if never_changes || 2 * n_valid < n_frames => Fate::Dead,
                () if 2 * n_late > lags.len() => Fate::Late,
                () if n_missing > 0 => Fate::Intermittent,
                () => Fate::Fine,
            };
            Condition {
                taxel: name.clone(),
                fate,
                n_frames,
                n_valid,
                n_missing,
                n_timed: lags.len(),
            }
        })
        .collect()
}

/// Whether a taxel is one frame later than the others in a press. `None` if the press does not show
/// it.
fn lags(press: &Press, taxel: usize) -> Option<bool> {
    let valid = |frame: usize, taxel: usize| press.valid[frame][taxel];
    let change_kpa =
        |frame: usize, taxel: usize| press.taxels_kpa[frame][taxel] - press.taxels_kpa[frame - 1][taxel];
    let others_kpa = |frame: usize| -> f64 {
        let others = (0..press.valid[frame].len()).filter(|&other| other != taxel);
        let both = others.filter(|&other| valid(frame, other) && valid(frame - 1, other));
        both.map(|other| change_kpa(frame, other)).sum()
    };
    // Sums of squares and products of this taxel's changes and the others' changes, in the same
    // frame and one frame earlier.
    let (mut own, mut now, mut before) = (0.0, [0.0; 2], [0.0; 2]);
    let mut n = 0;
    for frame in 2..press.time_s.len() {
        if !(valid(frame, taxel) && valid(frame - 1, taxel)) {
            continue;
        }
        n += 1;
        let change_kpa = change_kpa(frame, taxel);
        own += change_kpa.powi(2);
        for (sums, others_kpa) in [
            (&mut now, others_kpa(frame)),
            (&mut before, others_kpa(frame - 1)),
        ] {
            sums[0] += others_kpa.powi(2);
            sums[1] += others_kpa * change_kpa;
        }
    }
    let left = |[square, product]: [f64; 2]| {
        if square > 0.0 {
            own - product.powi(2) / square
        } else {
            own
        }
    };
    let (left_now, left_before) = (left(now), left(before));
    if n < FEWEST || own <= 0.0 {
        None
    } else if left_before * BETTER < left_now {
        Some(true)
    } else {
        (left_now * BETTER < left_before).then_some(false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, press, recording};

    /// The condition of the third of three taxels in one press, after `change` altered it.
    fn with_last(change: impl Fn(&mut Press)) -> Condition {
        let mut three = press(&Shape {
            loading_s: 0.2,
            hold_s: 0.5,
            noise_kpa: 0.01,
            ..Shape::default()
        });
        for rows in [&mut three.taxels_kpa, &mut three.taxels_raw] {
            for row in rows {
                row.push(0.5 * row[0]);
            }
        }
        three.valid.iter_mut().for_each(|valid| valid.push(true));
        change(&mut three);
        let mut recording = recording(vec![three]);
        recording.taxels.push("c".to_owned());
        conditions(&recording, &[]).remove(2)
    }

    #[test]
    fn dead_stuck_and_late_taxels_are_told_from_a_living_one() {
        let fine = with_last(|_| {});
        assert_eq!((fine.fate, fine.n_timed), (Fate::Fine, 1));
        let silent = with_last(|press| press.valid.iter_mut().for_each(|valid| valid[2] = false));
        assert_eq!((silent.fate, silent.n_valid), (Fate::Dead, 0));
        let zero = with_last(|press| press.taxels_raw.iter_mut().for_each(|raw| raw[2] = 0.0));
        assert_eq!(zero.fate, Fate::Dead);
        let stuck = with_last(|press| press.taxels_raw.iter_mut().for_each(|raw| raw[2] = 101.3));
        assert_eq!(stuck.fate, Fate::Stuck);
        let late = with_last(|press| {
            for frame in (1..press.taxels_kpa.len()).rev() {
                press.taxels_kpa[frame][2] = press.taxels_kpa[frame - 1][2];
            }
        });
        assert_eq!((late.fate, late.n_timed), (Fate::Late, 1));
    }

    /// Removes the last taxel's reading in some frames.
    fn silence(press: &mut Press, is_silent: impl Fn(usize) -> bool) {
        for frame in (0..press.time_s.len()).filter(|frame| is_silent(*frame)) {
            (press.taxels_kpa[frame][2], press.taxels_raw[frame][2]) = (f64::NAN, f64::NAN);
            press.valid[frame][2] = false;
        }
    }

    #[test]
    fn a_taxel_that_gives_nothing_at_times_is_intermittent_and_else_as_it_is() {
        let at_times = |frame: usize| frame % 7 == 3;
        let silent = with_last(|press| silence(press, at_times));
        assert_eq!(silent.fate, Fate::Intermittent);
        assert_eq!(silent.n_missing, silent.n_frames - silent.n_valid);
        assert!(silent.n_missing > 10, "{silent:?}");
        let stuck = with_last(|press| {
            press.taxels_raw.iter_mut().for_each(|raw| raw[2] = 101.3);
            silence(press, at_times);
        });
        assert_eq!(stuck.fate, Fate::Stuck, "silence is no change");
        let zero = with_last(|press| {
            press.taxels_raw.iter_mut().for_each(|raw| raw[2] = 0.0);
            silence(press, at_times);
        });
        assert_eq!(zero.fate, Fate::Dead);
        let dead = with_last(|press| silence(press, |frame| frame > 2));
        assert_eq!(dead.fate, Fate::Dead);
        let gone = with_last(|press| silence(press, |_| true));
        assert_eq!((gone.fate, gone.n_missing), (Fate::Dead, gone.n_frames));
    }

    #[test]
    fn a_slow_press_does_not_tell_whether_a_taxel_is_late() {
        let slow = press(&Shape {
            loading_s: 60.0,
            noise_kpa: 0.02,
            ..Shape::default()
        });
        assert_eq!(conditions(&recording(vec![slow]), &[])[0].n_timed, 0);
    }
}
