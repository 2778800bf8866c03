//! Coverage and width of intervals on presses that were not used for training.

use serde::{Deserialize, Serialize};

use super::{Certainty, Contact};
use crate::evaluation::predict_some;
use crate::{PairedPress, Places, Scale, Twin};

/// Quality of a twin's intervals, on presses that were not used for training. Excluded taxels do
/// not count. A figure is `None` if there is nothing to count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CertaintyScore {
    /// Number of evaluated readings: all usable ones, including those of non-contact frames.
    pub n_readings: usize,
    /// Fraction of them within their interval, %. It should be [`Certainty::level_percent`].
    pub covered_percent: Option<f64>,
    /// Mean width of the intervals over the largest reading of the file, %.
    pub mean_width_percent: Option<f64>,
    /// Number of evaluated readings of frames in contact.
    pub n_in_contact: usize,
    /// Fraction of these within their interval, %.
    pub covered_in_contact_percent: Option<f64>,
    /// Mean width of their intervals over the largest reading of the file, %.
    pub mean_width_in_contact_percent: Option<f64>,
    /// Fraction of the frames in contact that is flagged as out of distribution, %.
    pub flagged_percent: Option<f64>,
}

#[derive(Default)]
struct Sum {
    n: usize,
    covered: usize,
    width_percent: f64,
}

impl Sum {
    fn add(&mut self, is_covered: bool, width_percent: f64) {
        self.n += 1;
        self.covered += usize::from(is_covered);
        self.width_percent += width_percent;
    }

    fn covered_percent(&self) -> Option<f64> {
        percent(self.covered, self.n)
    }

    fn mean_width_percent(&self) -> Option<f64> {
        (self.n > 0).then(|| self.width_percent / self.n as f64)
    }
}

/// A fraction, %; `None` if there is nothing.
fn percent(part: usize, all: usize) -> Option<f64> {
    (all > 0).then(|| 100.0 * part as f64 / all as f64)
}

/// Evaluates the intervals of a twin on some presses of a recording. `contacts` are those of the
/// locations, `[n_places]`.
#[must_use]
pub fn score_certainty(
    (twin, certainty): (&Twin, &Certainty),
    recorded: &[PairedPress],
    (places, contacts): (&Places, &[Contact]),
    chosen: &[usize],
    scale: &Scale,
) -> CertaintyScore {
    let predicted = predict_some(twin, recorded, chosen);
    let (mut all, mut in_contact) = (Sum::default(), Sum::default());
    let (mut n_frames, mut n_flagged) = (0_usize, 0_usize);
    for (&index, predicted) in chosen.iter().zip(&predicted) {
        let press = &recorded[index];
        let largest_kpa = scale.largest_kpa.get(&press.mounting).copied().unwrap_or(0.0);
        if largest_kpa <= 0.0 {
            continue;
        }
        let contact = &contacts[places.of_press[index]];
        let features = &press.features;
        let sure = certainty.along(|_| contact, &features.time_s, &features.depth_mm, predicted);
        for (frame, row) in predicted.iter().enumerate() {
            let touches = features.depth_mm[frame] > 0.0;
            n_frames += usize::from(touches);
            n_flagged += usize::from(touches && sure.is_out_of_distribution[frame]);
            for (taxel, reading_kpa) in row.iter().enumerate() {
                if !press.valid[frame][taxel] || scale.left_out.contains(&taxel) {
                    continue;
                }
                let half_width_kpa = sure.half_width_kpa[frame][taxel];
                let is_covered = (press.readings_kpa[frame][taxel] - reading_kpa).abs() <= half_width_kpa;
                let width_percent = 200.0 * half_width_kpa / largest_kpa;
                all.add(is_covered, width_percent);
                if touches {
                    in_contact.add(is_covered, width_percent);
                }
            }
        }
    }
    CertaintyScore {
        n_readings: all.n,
        covered_percent: all.covered_percent(),
        mean_width_percent: all.mean_width_percent(),
        n_in_contact: in_contact.n,
        covered_in_contact_percent: in_contact.covered_percent(),
        mean_width_in_contact_percent: in_contact.mean_width_percent(),
        flagged_percent: percent(n_flagged, n_frames),
    }
}

/// Area under the ROC curve (AUROC): the probability that a number of `positive` is larger than one
/// of `negative`; ties count half. `None` if one of the two is empty.
#[must_use]
pub fn area_under_curve(negative: &[f64], positive: &[f64]) -> Option<f64> {
    if negative.is_empty() || positive.is_empty() {
        return None;
    }
    let mut sorted = negative.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let below = |number: &f64| {
        let (less, not_more) = (
            sorted.partition_point(|other| other < number),
            sorted.partition_point(|other| other <= number),
        );
        (less + not_more) as f64 / 2.0
    };
    let sum: f64 = positive.iter().map(below).sum();
    Some(sum / (negative.len() as f64 * positive.len() as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_area_counts_pairs() {
        assert_eq!(area_under_curve(&[0.0, 1.0], &[2.0, 3.0]), Some(1.0));
        assert_eq!(area_under_curve(&[0.0, 1.0], &[1.0, 0.0]), Some(0.5));
        assert_eq!(area_under_curve(&[2.0], &[1.0]), Some(0.0));
        assert_eq!(area_under_curve(&[], &[1.0]), None);
    }
}
