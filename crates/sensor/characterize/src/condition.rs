//! Which taxels are dead, stuck, late or intermittent.
//!
//! Dead: a taxel that gives nothing that can be used in most frames, or always the count zero. Stuck: one whose value never changes. Late: one whose
//! changes from frame to frame fit the changes of the other taxels a frame before at least twice as well (by the sum of squares that a common factor
//! leaves) as those of the same frame, in most presses that tell. A press tells where one of both fits twice as well as the other. Intermittent: one
//! that gives nothing in some frames. What a taxel does is told from the frames in which it gave something.

use serde::Serialize;
use twintac_recording::{Frames, Press, Recording};

/// Fewest frames of a press that tell whether a taxel is late, and of all presses whether it is stuck.
const FEWEST: usize = 10;

/// By how much one of two fits has to be better.
const BETTER: f64 = 2.0;

/// What has become of a taxel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Fate {
    /// It reads.
    Fine,
    /// It reads nothing, or zero for ever.
    Dead,
    /// It stays at one value.
    Stuck,
    /// It reads what it should have read a frame before.
    Late,
    /// It reads nothing in some frames.
    Intermittent,
}

/// A taxel's condition.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Condition {
    /// The taxel's name.
    pub taxel: String,
    /// What has become of it.
    pub fate: Fate,
    /// Frames.
    pub n_frames: usize,
    /// Those of them whose reading can be used.
    pub n_valid: usize,
    /// Those of them in which the taxel gave nothing.
    pub n_missing: usize,
    /// Presses that tell whether it is late.
    pub n_timed: usize,
}

/// From the presses; without any, from the logs, which do not tell whether a taxel is late.
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

/// Whether a taxel lags a frame behind the others in a press; `None` if the press does not tell.
fn lags(press: &Press, taxel: usize) -> Option<bool> {
    let valid = |frame: usize, taxel: usize| press.valid[frame][taxel];
    let change_kpa =
        |frame: usize, taxel: usize| press.taxels_kpa[frame][taxel] - press.taxels_kpa[frame - 1][taxel];
    let others_kpa = |frame: usize| -> f64 {
        let others = (0..press.valid[frame].len()).filter(|&other| other != taxel);
        let both = others.filter(|&other| valid(frame, other) && valid(frame - 1, other));
        both.map(|other| change_kpa(frame, other)).sum()
    };
    // Sums of squares and products of the taxel's changes and the others': of the same frame, and of the frame before.
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

    /// Three taxels that feel the same press, and what is done to the last of them.
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

    /// Lets the last taxel give nothing in some frames.
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
