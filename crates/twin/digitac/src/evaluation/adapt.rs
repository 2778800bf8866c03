//! A twin adapted to another sensor of the same description, from a few presses.
//!
//! Two casts differ in their gains, and two mountings in their contact heights. Both are fitted to the first presses that the twin would
//! feel well; all else stays as it was learned. These presses are not scored.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use twintac_depth_table::DepthTable;
use twintac_recording::{Control, Recording};

use super::recalibrate::felt;
use crate::bench_fit::{BenchEstimate, Estimate, Places, curves, features_along};
use crate::numerics::minimize;
use crate::{DigitacError, Twin};

/// A taxel that feels less than this part of what the others feel in these presses gets their mean factor.
const FELT_ENOUGH: f64 = 0.1;
/// Tolerance of the height, mm.
const TOLERANCE_MM: f64 = 2e-3;

/// What was adapted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Adaptation {
    /// By how much the tip is deeper than the recordings say, mm; of all their mountings.
    pub contact_offset_mm: f64,
    /// Gains over those that were learned; `[n_taxels]`.
    pub gain_factors: Vec<f64>,
    /// The presses that these were fitted to, by number: not to be scored.
    pub used: Vec<usize>,
}

/// Fits one contact height, within `limit_mm` of the bench's median, and the gains of all taxels to the first presses, `n_presses` at most, that the
/// twin would feel at least half as much as the most, by least absolute deviations. Taxels in `left_out` do not count for the height. `None`
/// without as many presses of prescribed pose, and some more to judge.
///
/// # Errors
/// Tables that do not go with the places; damaged presses.
pub fn adapt(
    recording: &Recording,
    (places, tables): (&Places, &[DepthTable]),
    bench: &BenchEstimate,
    twin: &Twin,
    n_presses: usize,
    limit_mm: f64,
    left_out: &BTreeSet<usize>,
) -> Result<Option<Adaptation>, DigitacError> {
    let posed: Vec<usize> = (0..recording.presses.len())
        .filter(|&index| recording.presses[index].control == Control::Pose)
        .collect();
    if n_presses == 0 || posed.len() <= n_presses {
        return Ok(None);
    }
    let curves = curves(places, tables, recording.taxels.len())?;
    let along = |index: usize, offset_mm: f64| {
        let (press, place) = (&recording.presses[index], places.of_press[index]);
        let touch_z_mm = places.requests[place].gel_from_indenter_at_touch.position_mm.z;
        features_along(&curves[place], press, touch_z_mm, &at_height(bench, offset_mm))
    };
    let center_mm = bench.contact_offset_elsewhere_mm;
    let used = felt(
        &posed,
        &|index| along(index, center_mm),
        twin,
        left_out,
        n_presses,
    )?;
    let fit = |offset_mm: f64| -> Result<(f64, Vec<f64>), DigitacError> {
        // Measured and predicted readings of each taxel.
        let mut readings: Vec<Vec<(f64, f64)>> = vec![Vec::new(); recording.taxels.len()];
        for &index in &used {
            let press = &recording.presses[index];
            let predicted = twin.predict(&[&along(index, offset_mm)?]).swap_remove(0);
            for ((row, measured), valid) in predicted.iter().zip(&press.taxels_kpa).zip(&press.valid) {
                for (taxel, readings) in readings.iter_mut().enumerate().filter(|(taxel, _)| valid[*taxel]) {
                    readings.push((measured[taxel], row[taxel]));
                }
            }
        }
        let factors = factors(&readings);
        let kept = readings.iter().zip(&factors).enumerate();
        let kept = kept.filter(|(taxel, _)| !left_out.contains(taxel));
        let deviation_kpa = kept
            .flat_map(|(_, (readings, factor))| readings.iter().map(move |(m, p)| (m - factor * p).abs()))
            .sum();
        Ok((deviation_kpa, factors))
    };
    let mut failure = None;
    let deviation_kpa = |offset_mm: f64| match fit(offset_mm) {
        Ok((deviation_kpa, _)) => deviation_kpa,
        Err(error) => {
            failure = Some(error);
            f64::INFINITY
        }
    };
    let range_mm = [center_mm - limit_mm, center_mm + limit_mm];
    let (contact_offset_mm, _) = minimize(range_mm[0], range_mm[1], TOLERANCE_MM, deviation_kpa);
    failure.map_or(Ok(()), Err)?;
    Ok(Some(Adaptation {
        contact_offset_mm,
        gain_factors: fit(contact_offset_mm)?.1,
        used,
    }))
}

impl Adaptation {
    /// The twin with its gains, and the bench with its contact height for all mountings.
    #[must_use]
    pub fn apply(&self, twin: &Twin, bench: &BenchEstimate) -> (Twin, BenchEstimate) {
        (
            twin.with_gain_factors(&self.gain_factors),
            at_height(bench, self.contact_offset_mm),
        )
    }
}

/// The bench with one contact height for all mountings.
fn at_height(bench: &BenchEstimate, offset_mm: f64) -> BenchEstimate {
    let height = Estimate {
        value: offset_mm,
        uncertainty: 0.0,
    };
    let mut bench = bench.clone();
    bench.contact_offset_mm.values_mut().for_each(|own| *own = height);
    bench.contact_offset_elsewhere_mm = offset_mm;
    bench
}

/// For each taxel the factor on predicted readings with the least absolute deviations: the median of the quotients, weighted by what is
/// predicted.
fn factors(readings: &[Vec<(f64, f64)>]) -> Vec<f64> {
    let felt: Vec<f64> = readings
        .iter()
        .map(|readings| readings.iter().map(|(_, p)| p.abs()).sum())
        .collect();
    let most = felt.iter().copied().fold(0.0, f64::max);
    let own: Vec<Option<f64>> = readings
        .iter()
        .zip(&felt)
        .map(|(readings, felt)| (*felt > FELT_ENOUGH * most).then(|| weighted_median(readings, *felt)))
        .collect();
    let found = || own.iter().flatten().filter(|factor| **factor > 0.0);
    let mean = found().sum::<f64>() / found().count().max(1) as f64;
    let usual = if mean > 0.0 { mean } else { 1.0 };
    own.iter()
        .map(|own| own.filter(|factor| *factor > 0.0).unwrap_or(usual))
        .collect()
}

fn weighted_median(readings: &[(f64, f64)], total: f64) -> f64 {
    let quotients = readings.iter().filter(|(_, p)| *p != 0.0);
    let mut sorted: Vec<(f64, f64)> = quotients.map(|(m, p)| (m / p, p.abs())).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut below = 0.0;
    for (quotient, weight) in &sorted {
        below += weight;
        if 2.0 * below >= total {
            return *quotient;
        }
    }
    1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_those_of_most_readings_and_the_mean_for_what_is_hardly_felt() {
        let along = |factor: f64, size: f64| -> Vec<(f64, f64)> {
            (1..40)
                .map(|i| (factor * size * f64::from(i), size * f64::from(i)))
                .collect()
        };
        let mut readings = vec![along(1.2, 1.0), along(0.8, 0.7), along(5.0, 1e-3)];
        readings[0][3].0 = 900.0;
        let found = factors(&readings);
        assert!(
            (found[0] - 1.2).abs() < 1e-12 && (found[1] - 0.8).abs() < 1e-12,
            "{found:?}"
        );
        assert!((found[2] - 1.0).abs() < 1e-12, "{found:?}");
    }
}
