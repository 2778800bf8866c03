//! Drift of the unloaded readings: after a press, and with temperature.

use serde::Serialize;
use twintac_recording::Provenance;
use twintac_temperature::{Compensation, TaxelDrift};

use crate::Finding;
use crate::rest::Rest;
use crate::statistics::{binned, line, mean};
use crate::untouched::Untouched;

/// Smallest range of temperature that gives a coefficient, K.
const LEAST_K: f64 = 1.0;

/// Number of steps of temperature in which readings are averaged.
const STEPS: usize = 25;

/// How closely a taxel returns to zero after a press.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ZeroReturn {
    /// The taxel's name.
    pub taxel: String,
    /// Root mean square over presses of the unloaded reading after a press, minus that before, kPa.
    pub rms_kpa: f64,
    /// Number of presses it was found from.
    pub n_presses: usize,
}

/// Drift of a taxel's zero with temperature.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TemperatureDrift {
    /// The taxel's name.
    pub taxel: String,
    /// Slope of the least-squares line of unloaded pressure over temperature, kPa/K.
    pub coefficient_kpa_per_k: f64,
    /// Lowest and highest temperature, °C.
    pub between_c: [f64; 2],
    /// Root mean square of the residuals of the line, kPa. Readings are averaged over five seconds.
    pub remaining_kpa: f64,
    /// Number of readings it was found from.
    pub n_readings: usize,
    /// Means of the readings in order of temperature: temperature, °C, and unloaded pressure minus
    /// the line's value at the lowest temperature, kPa.
    pub course: Vec<[f64; 2]>,
}

pub(crate) fn zero_return(rests: &[Rest<'_>], taxels: &[String]) -> Finding<Vec<ZeroReturn>> {
    let found = taxels.iter().enumerate().filter_map(|(taxel, name)| {
        let changes = rests.iter().filter_map(|rest| rest.change_kpa(taxel));
        let squares: Vec<f64> = changes.map(|change_kpa: f64| change_kpa.powi(2)).collect();
        Some(ZeroReturn {
            taxel: name.clone(),
            rms_kpa: mean(&squares)?.sqrt(),
            n_presses: squares.len(),
        })
    });
    Finding::of_list(found.collect(), "no press has unloaded frames before and after")
}

pub(crate) fn with_temperature(untouched: &[Untouched], taxels: &[String]) -> Finding<Vec<TemperatureDrift>> {
    let mut widest_k: Option<f64> = None;
    let mut found = Vec::new();
    for (of_taxel, name) in untouched.iter().zip(taxels) {
        let windows = || of_taxel.windows.iter();
        let points = windows().filter_map(|window| Some([window.temperature_c?, window.mean_kpa]));
        let points: Vec<[f64; 2]> = points.collect();
        let temperatures_c = points.iter().map(|point| point[0]);
        let low_c = temperatures_c.clone().fold(f64::INFINITY, f64::min);
        let high_c = temperatures_c.fold(f64::NEG_INFINITY, f64::max);
        if !points.is_empty() {
            widest_k = Some(widest_k.unwrap_or(0.0).max(high_c - low_c));
        }
        if high_c - low_c < LEAST_K {
            continue;
        }
        let Some([coefficient_kpa_per_k, at_zero_kpa]) = line(&points) else {
            continue;
        };
        let at_low_kpa = at_zero_kpa + coefficient_kpa_per_k * low_c;
        let above: Vec<[f64; 2]> = points
            .iter()
            .map(|[c, kpa]| [c - low_c, kpa - at_low_kpa])
            .collect();
        let squares = above
            .iter()
            .map(|[k, kpa]| (kpa - coefficient_kpa_per_k * k).powi(2));
        let squares: Vec<f64> = squares.collect();
        let with_temperature = windows().filter(|window| window.temperature_c.is_some());
        found.push(TemperatureDrift {
            taxel: name.clone(),
            coefficient_kpa_per_k,
            between_c: [low_c, high_c],
            remaining_kpa: mean(&squares).unwrap_or(0.0).sqrt(),
            n_readings: with_temperature.map(|window| window.n_readings).sum(),
            course: binned(&above, high_c - low_c, STEPS)
                .into_iter()
                .map(|[above_k, kpa]| [low_c + above_k, kpa])
                .collect(),
        });
    }
    let why = match widest_k {
        None => {
            "there are no temperatures of untouched taxels; logs and tables of frames have them".to_owned()
        }
        Some(widest_k) => {
            format!(
                "temperatures while nothing touches change by {widest_k:.2} K, at least {LEAST_K} K are required"
            )
        }
    };
    Finding::of_list(found, &why)
}

/// The coefficients as a file for compensating readings.
pub(crate) fn compensation(
    sensor: &str,
    provenance: Provenance,
    found: &Finding<Vec<TemperatureDrift>>,
) -> Option<Compensation> {
    let taxels = found.found()?.iter().map(|drift| TaxelDrift {
        name: drift.taxel.clone(),
        kpa_per_k: drift.coefficient_kpa_per_k,
        between_c: drift.between_c,
        remaining_kpa: drift.remaining_kpa,
    });
    Some(Compensation {
        sensor: sensor.to_owned(),
        provenance,
        taxels: taxels.collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, noise, press, rests, untouched};

    #[test]
    fn a_coefficient_is_found_where_the_temperature_changes() {
        let taxels = ["a", "b"].map(str::to_owned);
        let warming = |span_k: f64| {
            let is_c = move |at_s: f64| 25.0 + span_k * at_s / 600.0;
            let reads_kpa = |at_s: f64| {
                [
                    101.0 + 0.3 * is_c(at_s) + 0.015 * noise(0.0, (50.0 * at_s) as usize),
                    99.0,
                ]
            };
            with_temperature(&Untouched::all(&[untouched(600.0, reads_kpa, is_c)], 2), &taxels)
        };
        let finding = warming(5.0);
        let found = &finding.found().unwrap()[0];
        assert!((found.coefficient_kpa_per_k - 0.3).abs() < 1e-3, "{found:?}");
        assert!(
            found.remaining_kpa < 2e-3 && found.n_readings == 30_000,
            "{found:?}"
        );
        assert!((found.between_c[0] - 25.0).abs() < 0.05 && (found.between_c[1] - 30.0).abs() < 0.05);
        assert_eq!(found.course.len(), STEPS);
        assert!(
            found
                .course
                .iter()
                .all(|[c, kpa]| (kpa - 0.3 * (c - 25.02)).abs() < 0.01)
        );
        let file = compensation("pair", Provenance::Real, &finding).unwrap();
        assert_eq!(file.taxels[0].kpa_per_k, found.coefficient_kpa_per_k);
        assert!(warming(0.5).why_not().unwrap().contains("0.50 K"));
        let without = with_temperature(&Untouched::all(&[], 2), &taxels);
        assert!(without.why_not().unwrap().contains("no temperatures"));
        assert!(compensation("pair", Provenance::Real, &without).is_none());
    }

    #[test]
    fn what_stays_behind_after_a_press_is_found() {
        let shape = Shape {
            reads: |force_n, phase, _| 7.0 * force_n + if phase == 2 { 0.3 } else { 0.0 },
            ..Shape::default()
        };
        let presses = [press(&shape)];
        let finding = zero_return(&rests(&presses), &["a".to_owned(), "b".to_owned()]);
        assert!((finding.found().unwrap()[0].rms_kpa - 0.3).abs() < 1e-9);
    }
}
