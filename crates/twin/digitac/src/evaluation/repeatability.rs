//! How well measured presses repeat: what two presses of the same place, depth and speed differ by.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::{Errors, Scale, score};
use crate::{Features, PairedPress};

/// The definition that goes with the numbers.
const DEFINITION: &str = "Two presses of one indenter at one place (within 0.05 mm), to one depth (within 0.05 mm) and at one speed (within 10 %) \
    are compared phase by phase: going down and coming up at the same depth, holding at the same time after the end of the way down, coming up \
    only after holds of one length (within 10 % or 0.2 s). Errors are those of taking one's readings for the other's; a twin that predicts the mean of \
    both has half of them.";

/// Places closer than this are one, mm.
const SAME_PLACE_MM: f64 = 0.05;
/// Depths closer than this are one, mm.
const SAME_DEPTH_MM: f64 = 0.05;
/// Speeds and durations whose ratio is closer to one than this are one.
const SAME_RATIO: f64 = 0.1;
/// Holds that differ by less are of one length, s.
const SAME_HOLD_S: f64 = 0.2;
/// A hold begins and ends where the depth is this close to the deepest, mm.
const HOLD_MM: f64 = 0.02;

/// How well presses repeat.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Repeatability {
    /// What the numbers mean.
    pub definition: String,
    /// Pairs of presses that repeat each other.
    pub n_pairs: usize,
    /// Errors of predicting one press's readings by the other's.
    pub errors: Errors,
}

/// Compares all presses that repeat each other. `None` if none do.
#[must_use]
pub fn repeatability(presses: &[PairedPress], scale: &Scale) -> Option<Repeatability> {
    let mut compared = Vec::new();
    let mut predictions = Vec::new();
    for (index, first) in presses.iter().enumerate() {
        for second in &presses[index + 1..] {
            let close = |axis: usize| (first.place_mm[axis] - second.place_mm[axis]).abs() < SAME_PLACE_MM;
            if first.indenter == second.indenter
                && close(0)
                && close(1)
                && let Some((common, other)) = compare(first, second)
            {
                compared.push(common);
                predictions.push(other);
            }
        }
    }
    (!compared.is_empty()).then(|| Repeatability {
        definition: DEFINITION.to_owned(),
        n_pairs: compared.len(),
        errors: score(&compared, &predictions, scale).overall,
    })
}

/// Frames of one way down, one hold and one way up.
struct Phases {
    down: Range<usize>,
    hold: Range<usize>,
    up: Range<usize>,
    deepest_mm: f64,
    /// Of the way down, from first touch.
    down_s: f64,
    hold_s: f64,
}

impl Phases {
    /// `None` if the gel is not touched on the way down.
    fn of(features: &Features) -> Option<Self> {
        let depth_mm = &features.depth_mm;
        let deepest_mm = depth_mm.iter().copied().fold(0.0, f64::max);
        let touch = depth_mm.iter().position(|depth| *depth > 0.0)?;
        let is_held = |depth: &f64| deepest_mm - depth < HOLD_MM;
        let start = depth_mm.iter().position(is_held)?;
        let end = depth_mm.iter().rposition(is_held)? + 1;
        let out = (end..depth_mm.len())
            .find(|&i| depth_mm[i] <= 0.0)
            .unwrap_or(depth_mm.len());
        let time_s = &features.time_s;
        (start > touch).then(|| Self {
            down: touch..start,
            hold: start..end,
            up: end..out,
            deepest_mm,
            down_s: time_s[start] - time_s[touch],
            hold_s: time_s[end - 1] - time_s[start],
        })
    }
}

/// The first press where both are in the same phase, and the second's readings at its frames.
fn compare(first: &PairedPress, second: &PairedPress) -> Option<(PairedPress, Vec<Vec<f64>>)> {
    let (f, g) = (&first.features, &second.features);
    let (a, b) = (Phases::of(f)?, Phases::of(g)?);
    let alike = |one: f64, other: f64| (one - other).abs() <= SAME_RATIO * one.max(other);
    if (a.deepest_mm - b.deepest_mm).abs() > SAME_DEPTH_MM || !alike(a.down_s, b.down_s) {
        return None;
    }
    let negative = |depth_mm: &[f64]| -> Vec<f64> { depth_mm.iter().map(|depth| -depth).collect() };
    let mut frames: Vec<(usize, f64)> = Vec::new();
    let mut add = |own: Range<usize>, at: &dyn Fn(usize) -> Option<f64>| {
        frames.extend(own.filter_map(|frame| Some((frame, at(frame)?))));
    };
    add(a.down.clone(), &|i| index_at(&g.depth_mm, &b.down, f.depth_mm[i]));
    let (held_since_s, other_since_s) = (f.time_s[a.hold.start], g.time_s[b.hold.start]);
    add(a.hold.clone(), &|i| {
        index_at(&g.time_s, &b.hold, f.time_s[i] - held_since_s + other_since_s)
    });
    if alike(a.hold_s, b.hold_s) || (a.hold_s - b.hold_s).abs() < SAME_HOLD_S {
        let rising = negative(&g.depth_mm);
        add(a.up.clone(), &|i| index_at(&rising, &b.up, -f.depth_mm[i]));
    }
    let mut common = first.clone();
    let pick = |rows: &[f64]| frames.iter().map(|(i, _)| rows[*i]).collect::<Vec<f64>>();
    common.features.time_s = pick(&f.time_s);
    common.features.depth_mm = pick(&f.depth_mm);
    common.features.simulated = vec![true; frames.len()];
    common.readings_kpa = frames
        .iter()
        .map(|(i, _)| first.readings_kpa[*i].clone())
        .collect();
    let mut other = Vec::with_capacity(frames.len());
    common.valid = frames
        .iter()
        .map(|(i, at)| {
            let (low, share) = (*at as usize, at.fract());
            let high = (low + 1).min(second.readings_kpa.len() - 1);
            let rows = second.readings_kpa[low].iter().zip(&second.readings_kpa[high]);
            other.push(rows.map(|(l, h)| l + share * (h - l)).collect());
            let valid = second.valid[low].iter().zip(&second.valid[high]);
            first.valid[*i]
                .iter()
                .zip(valid)
                .map(|(own, (l, h))| *own && *l && *h)
                .collect()
        })
        .collect();
    (!frames.is_empty()).then_some((common, other))
}

/// The index, between the frames of a phase, at which rising values come to one.
fn index_at(values: &[f64], phase: &Range<usize>, at: f64) -> Option<f64> {
    let after = phase.clone().find(|&i| values[i] >= at)?;
    let before = after.checked_sub(1).filter(|before| phase.contains(before));
    match before {
        Some(before) => Some(before as f64 + (at - values[before]) / (values[after] - values[before])),
        None => (values[after] == at).then_some(after as f64),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::synthetic::by_hand;

    /// Down at 1 mm/s from 0.5 mm above, a hold, and up; readings proportional to the depth.
    fn press(place_mm: f64, deepest_mm: f64, hold_s: f64, late_s: f64, gain: f64) -> PairedPress {
        let up_s = 0.5 + deepest_mm + hold_s + late_s;
        let depth = |i: i32| {
            let t = 0.1 * f64::from(i);
            (t - late_s - 0.5).min(deepest_mm).min(deepest_mm - (t - up_s))
        };
        let frames: Vec<(f64, [f64; 2])> = (0..90)
            .map(|i| (depth(i), [gain * depth(i).max(0.0), 0.0]))
            .collect();
        by_hand("", "file", [place_mm, 0.0], &frames)
    }

    #[test]
    fn the_same_press_is_compared_phase_by_phase_whatever_its_delay() {
        let presses = [
            press(0.0, 2.0, 1.0, 0.0, 10.0),
            press(0.01, 2.0, 1.0, 0.07, 10.2),
            press(0.0, 3.0, 1.0, 0.0, 20.0),
            press(1.0, 2.0, 1.0, 0.0, 15.0),
        ];
        let scale = Scale::of(&presses[..1], BTreeSet::new());
        let found = repeatability(&presses, &scale).unwrap();
        assert_eq!(found.n_pairs, 1);
        // Two percent of the reading, which itself grows up to the largest and falls again.
        let percent = found.errors.nearest_in_contact.percent.unwrap();
        assert!((1.0..1.6).contains(&percent), "{found:?}");
        assert!(found.errors.nearest_in_contact.count > 40, "{found:?}");
    }

    #[test]
    fn the_way_up_after_another_hold_is_not_compared() {
        let presses = [press(0.0, 2.0, 1.0, 0.0, 10.0), press(0.0, 2.0, 3.0, 0.0, 10.0)];
        let found = repeatability(&presses, &Scale::of(&presses, BTreeSet::new())).unwrap();
        assert!(
            found.errors.nearest_in_contact.percent.unwrap() < 1e-9,
            "{found:?}"
        );
        assert!(
            (25..32).contains(&found.errors.nearest_in_contact.count),
            "{found:?}"
        );
    }

    #[test]
    fn nothing_repeats_nothing() {
        let presses = [press(0.0, 2.0, 1.0, 0.0, 10.0), press(1.0, 2.0, 1.0, 0.0, 10.0)];
        assert!(repeatability(&presses, &Scale::of(&presses, BTreeSet::new())).is_none());
    }
}
