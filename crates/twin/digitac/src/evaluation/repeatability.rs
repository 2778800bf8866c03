//! Repeatability of measured presses: the difference between two presses of the same location,
//! depth and speed.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::{Errors, Scale, score};
use crate::{Features, PairedPress};

/// The definition that is stored with the figures.
const DEFINITION: &str = "Two presses of one indenter at one place (within 0.05 mm), to one depth (within 0.05 mm) and at one speed (within 10 %) \
    are compared phase by phase: going down and coming up at the same depth, holding at the same time after the end of the way down, coming up \
    only after holds of one length (within 10 % or 0.2 s). Errors are those of taking one's readings for the other's; a twin that predicts the mean of \
    both has half of them.";

/// Locations closer than this count as equal, mm.
const SAME_PLACE_MM: f64 = 0.05;
/// Depths closer than this count as equal, mm.
const SAME_DEPTH_MM: f64 = 0.05;
/// Speeds and durations count as equal if their ratio is closer to one than this.
const SAME_RATIO: f64 = 0.1;
/// Durations of holds that differ by less count as equal, s.
const SAME_HOLD_S: f64 = 0.2;
/// A hold has the depths this close to the deepest, mm.
const HOLD_MM: f64 = 0.02;

/// Repeatability of presses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Repeatability {
    /// Definition of the figures.
    pub definition: String,
    /// Number of pairs of presses that repeat each other.
    pub n_pairs: usize,
    /// Errors of predicting the readings of one press by those of the other.
    pub errors: Errors,
}

/// Compares all presses that repeat each other; `None` if there are none.
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

/// Frames of loading, hold and unloading.
struct Phases {
    down: Range<usize>,
    hold: Range<usize>,
    up: Range<usize>,
    deepest_mm: f64,
    /// Duration of loading from first touch, s.
    down_s: f64,
    hold_s: f64,
}

impl Phases {
    /// `None` if the gel is not touched during loading.
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

/// The frames of the first press in which both are in the same phase, and the readings of the
/// second press at these frames.
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

/// The fractional index, among the frames of a phase, at which rising values reach `at`.
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

    /// Down at 1 mm/s from 0.5 mm above, a hold, and up; readings are proportional to the depth.
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
        // Two percent of the reading, which itself rises to the largest and falls again.
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
