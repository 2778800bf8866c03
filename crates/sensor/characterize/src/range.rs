//! The range of forces and readings that the data cover.

use serde::Serialize;

use crate::recorded::Recorded;
use crate::{DetectionLimit, Finding};

/// The largest force and reading in the data. Nothing is known beyond.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CoveredRange {
    /// The largest force, N, anywhere on the gel, at which all readings that exist are valid.
    pub force_n: f64,
    /// The taxel with the largest reading in that frame.
    pub taxel: String,
    /// Its reading above its baseline in that frame, kPa.
    pub reading_kpa: f64,
    /// Name of that press.
    pub press: String,
    /// Number of readings under load that were not valid: at an end of the barometers' range, or
    /// missing.
    pub n_invalid: usize,
    /// Ratio of the largest force to the smallest detection limit of a single reading, dB (20
    /// log10).
    pub dynamic_range_db: Option<f64>,
}

pub(crate) fn covered(
    recorded: &[Recorded<'_>],
    taxels: &[String],
    limits: &Finding<Vec<DetectionLimit>>,
) -> Finding<CoveredRange> {
    let mut best: Option<CoveredRange> = None;
    let mut n_invalid = 0;
    for press in recorded {
        let frames = press.phases.loading.start..press.phases.unloading.end;
        let invalid = frames.clone().flat_map(|frame| &press.press.valid[frame]);
        n_invalid += invalid.filter(|valid| !**valid).count();
        // A missing reading does not limit the range. A reading that cannot be used is at the end
        // of the barometers' range.
        let is_there = |frame: usize, taxel: usize| !press.press.taxels_raw[frame][taxel].is_nan();
        let is_in_range = |frame: &usize| {
            (0..taxels.len()).all(|taxel| press.press.valid[*frame][taxel] || !is_there(*frame, taxel))
        };
        for frame in frames.filter(is_in_range) {
            let readings_kpa = &press.press.taxels_kpa[frame];
            let force_n = press.force_n(frame);
            let given = (0..taxels.len()).filter(|taxel| is_there(frame, *taxel));
            let most = given.max_by(|&a, &b| readings_kpa[a].total_cmp(&readings_kpa[b]));
            let Some(taxel) = most else { continue };
            if best.as_ref().is_none_or(|best| force_n > best.force_n) {
                best = Some(CoveredRange {
                    force_n,
                    taxel: taxels[taxel].clone(),
                    reading_kpa: readings_kpa[taxel],
                    press: press.press.name.clone(),
                    n_invalid: 0,
                    dynamic_range_db: None,
                });
            }
        }
    }
    let limits_n = limits
        .found()
        .into_iter()
        .flatten()
        .map(|limit| limit.single_reading_n);
    let smallest_n = limits_n.fold(f64::INFINITY, f64::min);
    best.map_or_else(
        || Finding::NotGiven("there is no press of known force with valid readings".to_owned()),
        |best| {
            let ratio = best.force_n / smallest_n;
            Finding::Found(CoveredRange {
                n_invalid,
                dynamic_range_db: (ratio > 0.0).then(|| 20.0 * ratio.log10()),
                ..best
            })
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, all, press};

    #[test]
    fn the_largest_force_with_a_valid_reading_counts() {
        let mut saturated = press(&Shape {
            peak_n: 9.0,
            ..Shape::default()
        });
        for (valid, force_n) in saturated
            .valid
            .iter_mut()
            .zip(saturated.force_n.as_ref().unwrap())
        {
            valid[0] = *force_n < 5.0;
        }
        // A taxel without any reading does not limit the range.
        for (taxels, valid) in saturated
            .taxels_kpa
            .iter_mut()
            .zip(&mut saturated.taxels_raw)
            .zip(&mut saturated.valid)
        {
            (taxels.0[1], taxels.1[1], valid[1]) = (f64::NAN, f64::NAN, false);
        }
        let presses = [press(&Shape::default()), saturated];
        let limits = Finding::NotGiven(String::new());
        let finding = covered(&all(&presses), &["a".to_owned(), "b".to_owned()], &limits);
        let found = finding.found().unwrap();
        assert!(
            found.force_n > 4.8 && found.force_n < 5.0 && found.n_invalid > 50,
            "{found:?}"
        );
        assert!((found.reading_kpa - 7.0 * found.force_n).abs() < 1e-9);
    }
}
