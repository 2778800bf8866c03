//! Drift of the unloaded readings: over a press, and with temperature.

use serde::Serialize;

use crate::Finding;
use crate::rest::Rest;
use crate::statistics::{binned, line, mean};

/// Smallest change of temperature that tells a coefficient, K.
const LEAST_K: f64 = 1.0;

/// Steps of temperature that readings are averaged in.
const STEPS: usize = 25;

/// How far a taxel comes back to zero after a press.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ZeroReturn {
    /// The taxel's name.
    pub taxel: String,
    /// Root mean square of the unloaded reading after a press, less that before, kPa.
    pub rms_kpa: f64,
    /// Presses that it was found from.
    pub n_presses: usize,
}

/// Unloaded readings of a taxel with their temperature.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UnloadedCourse {
    /// The taxel's name.
    pub taxel: String,
    /// Temperature, °C, and absolute pressure, kPa.
    pub readings: Vec<[f64; 2]>,
}

/// How a taxel's zero moves with temperature.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TemperatureDrift {
    /// The taxel's name.
    pub taxel: String,
    /// Slope of the least-squares line of unloaded pressure over temperature, kPa/K.
    pub coefficient_kpa_per_k: f64,
    /// From which temperature to which, °C.
    pub between_c: [f64; 2],
    /// Readings that it was found from.
    pub n_readings: usize,
    /// Means of the readings by rising temperature: °C, and unloaded pressure less the line's at the lowest temperature, kPa.
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

pub(crate) fn with_temperature(courses: &[UnloadedCourse]) -> Finding<Vec<TemperatureDrift>> {
    if courses.iter().all(|course| course.readings.is_empty()) {
        return Finding::NotGiven(
            "the recordings hold no temperatures; logs do, recordings of presses in Parquet do not"
                .to_owned(),
        );
    }
    let mut widest_k: f64 = 0.0;
    let mut found = Vec::new();
    for course in courses {
        let temperatures_c = course.readings.iter().map(|reading| reading[0]);
        let low_c = temperatures_c.clone().fold(f64::INFINITY, f64::min);
        let high_c = temperatures_c.fold(f64::NEG_INFINITY, f64::max);
        widest_k = widest_k.max(high_c - low_c);
        if high_c - low_c < LEAST_K {
            continue;
        }
        if let Some([coefficient_kpa_per_k, at_zero_kpa]) = line(&course.readings) {
            let at_low_kpa = at_zero_kpa + coefficient_kpa_per_k * low_c;
            let above = course.readings.iter();
            let above: Vec<[f64; 2]> = above.map(|[c, kpa]| [c - low_c, kpa - at_low_kpa]).collect();
            found.push(TemperatureDrift {
                taxel: course.taxel.clone(),
                coefficient_kpa_per_k,
                between_c: [low_c, high_c],
                n_readings: course.readings.len(),
                course: binned(&above, high_c - low_c, STEPS)
                    .into_iter()
                    .map(|[above_k, kpa]| [low_c + above_k, kpa])
                    .collect(),
            });
        }
    }
    let why = format!("temperatures in the recordings change by {widest_k:.2} K, and it takes {LEAST_K} K");
    Finding::of_list(found, &why)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, press, rests};

    #[test]
    fn a_coefficient_is_found_where_the_temperature_changes() {
        let course = |span_k: f64| UnloadedCourse {
            taxel: "a".into(),
            readings: (0..50)
                .map(|i| 25.0 + span_k * f64::from(i) / 49.0)
                .map(|c| [c, 101.0 + 0.3 * c])
                .collect(),
        };
        let finding = with_temperature(&[course(5.0)]);
        let found = &finding.found().unwrap()[0];
        assert!((found.coefficient_kpa_per_k - 0.3).abs() < 1e-9 && found.between_c == [25.0, 30.0]);
        assert_eq!(found.course.len(), STEPS);
        assert!(
            found
                .course
                .iter()
                .all(|[c, kpa]| (kpa - 0.3 * (c - 25.0)).abs() < 1e-9)
        );
        assert!(
            with_temperature(&[course(0.5)])
                .why_not()
                .unwrap()
                .contains("0.50 K")
        );
        assert!(
            with_temperature(&[])
                .why_not()
                .unwrap()
                .contains("no temperatures")
        );
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
