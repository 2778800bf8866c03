//! How well measured presses repeat. A twin that is given only the press cannot be expected to have much smaller errors than this.

use serde::{Deserialize, Serialize};

use super::{Errors, Scale, score};
use crate::{PairedPress, Warp};

/// The definition that goes with the numbers.
const DEFINITION: &str = "Two presses of one indenter at one place (within 0.05 mm) are compared from first touch for as long as both were \
    driven alike (depths within 0.05 mm), in contact for at least 0.5 s. Errors are those of taking one's readings for the other's, so a \
    twin that predicts their mean has half of them.";

/// Places closer than this are one, mm.
const SAME_PLACE_MM: f64 = 0.05;
/// Depths closer than this are one, mm.
const SAME_DEPTH_MM: f64 = 0.05;
/// Shortest common stretch that counts, s.
const SHORTEST_S: f64 = 0.5;

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
                && let Some((common, other)) = common_stretch(first, second)
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

/// The first press from first touch for as long as the second was driven alike, and the second's readings at
/// its frames.
fn common_stretch(first: &PairedPress, second: &PairedPress) -> Option<(PairedPress, Vec<Vec<f64>>)> {
    let (touch_s, other_touch_s) = (touch_time_s(first)?, touch_time_s(second)?);
    let (f, g) = (&first.features, &second.features);
    let start = f.time_s.partition_point(|t| *t < touch_s);
    let at = |frame: usize| index_at(&g.time_s, f.time_s[frame] - touch_s + other_touch_s);
    let mut frames = Vec::new();
    for frame in start..f.n_frames() {
        let Some(index) = at(frame) else { break };
        let warp = Warp {
            measured_index: vec![index],
            cost: 0.0,
            largest_shift_s: 0.0,
        };
        let depth_mm = warp.apply(&g.depth_mm.iter().map(|d| vec![*d]).collect::<Vec<_>>())[0][0];
        if (depth_mm - f.depth_mm[frame]).abs() > SAME_DEPTH_MM {
            break;
        }
        frames.push((frame, index));
    }
    let (&(from, _), &(to, _)) = (frames.first()?, frames.last()?);
    if f.time_s[to] - f.time_s[from] < SHORTEST_S {
        return None;
    }
    let indices = frames.iter().map(|(_, index)| *index).collect();
    let warp = Warp {
        measured_index: indices,
        cost: 0.0,
        largest_shift_s: 0.0,
    };
    let other_valid = warp.apply_valid(&second.valid);
    let mut common = first.clone();
    let c = &mut common.features;
    c.time_s = f.time_s[from..=to].to_vec();
    c.depth_mm = f.depth_mm[from..=to].to_vec();
    c.simulated = vec![true; c.time_s.len()];
    common.readings_kpa = first.readings_kpa[from..=to].to_vec();
    common.valid = first.valid[from..=to].to_vec();
    for (row, other) in common.valid.iter_mut().zip(&other_valid) {
        row.iter_mut()
            .zip(other)
            .for_each(|(valid, other)| *valid &= *other);
    }
    Some((common, warp.apply(&second.readings_kpa)))
}

/// When the tip first passes the surface, between frames, s.
fn touch_time_s(press: &PairedPress) -> Option<f64> {
    let f = &press.features;
    let after = f.depth_mm.iter().position(|depth| *depth > 0.0)?;
    let before = after.checked_sub(1)?;
    let share = f.depth_mm[before] / (f.depth_mm[before] - f.depth_mm[after]);
    Some(f.time_s[before] + share * (f.time_s[after] - f.time_s[before]))
}

/// The index, between frames, of a time.
fn index_at(time_s: &[f64], at_s: f64) -> Option<f64> {
    let after = time_s.partition_point(|t| *t <= at_s);
    if after == 0 || after == time_s.len() {
        return None;
    }
    let (low, high) = (time_s[after - 1], time_s[after]);
    Some((after - 1) as f64 + (at_s - low) / (high - low))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::synthetic::by_hand;

    /// Down at 1 mm/s from 0.5 mm above, then a hold; readings proportional to the depth.
    fn press(place_mm: f64, deepest_mm: f64, late_s: f64, gain: f64) -> PairedPress {
        let depth = |i: i32| (0.1 * f64::from(i) - late_s - 0.5).min(deepest_mm);
        let frames: Vec<(f64, [f64; 2])> = (0..60)
            .map(|i| (depth(i), [gain * depth(i).max(0.0), 0.0]))
            .collect();
        by_hand("", "file", [place_mm, 0.0], &frames)
    }

    #[test]
    fn the_same_press_is_compared_whatever_its_delay_and_only_while_it_is_the_same() {
        let presses = [
            press(0.0, 2.0, 0.0, 10.0),
            press(0.01, 3.0, 0.07, 10.2),
            press(1.0, 2.0, 0.0, 15.0),
        ];
        let scale = Scale::of(&presses[..1], BTreeSet::new());
        let found = repeatability(&presses, &scale).unwrap();
        assert_eq!(found.n_pairs, 1);
        // Two percent of the reading, which itself grows up to the largest.
        let percent = found.errors.nearest_in_contact.percent;
        assert!((0.8..1.3).contains(&percent), "{found:?}");
        assert!(
            (19..=21).contains(&found.errors.nearest_in_contact.count),
            "{found:?}"
        );
    }

    #[test]
    fn nothing_repeats_nothing() {
        let presses = [press(0.0, 2.0, 0.0, 10.0), press(1.0, 2.0, 0.0, 10.0)];
        assert!(repeatability(&presses, &Scale::of(&presses, BTreeSet::new())).is_none());
    }
}
