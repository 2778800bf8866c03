//! Figures of the report that show presses.

use std::collections::BTreeSet;

use digitac::{Evaluation, PairedPress, PressEvaluation};
use twintac_map::Rectangle;
use twintac_report::data::{Agreement, DepthError, PlaceErrors, PressPeak, PressSeries};
use twintac_sensor::Sensor;

/// Readings shown in the scatter plot, at most.
const MOST_READINGS: usize = 20_000;

/// Bins of the depth.
const DEPTH_BINS: usize = 8;

/// Readings below this share of the file's largest do not count as contact.
const CONTACT_SHARE: f64 = 0.03;

fn error(press: &PressEvaluation) -> f64 {
    press.errors.nearest_in_contact.percent
}

/// Presses that touched, from the best to the worst.
fn ranked(evaluation: &Evaluation) -> Vec<&PressEvaluation> {
    let mut presses: Vec<_> = evaluation
        .presses
        .iter()
        .filter(|p| p.errors.nearest_in_contact.count > 0)
        .collect();
    presses.sort_by(|a, b| error(a).total_cmp(&error(b)));
    presses
}

/// The best, the median and the worst.
fn three(evaluation: &Evaluation) -> Vec<(&'static str, &PressEvaluation)> {
    let ranked = ranked(evaluation);
    match ranked.len() {
        0 => Vec::new(),
        n => vec![
            ("best", ranked[0]),
            ("median", ranked[n / 2]),
            ("worst", ranked[n - 1]),
        ],
    }
}

/// Readings over time of the best, the median and the worst press.
pub(crate) fn series(evaluation: &Evaluation, presses: &[PairedPress]) -> Vec<PressSeries> {
    three(evaluation)
        .into_iter()
        .filter(|(_, press)| press.time_s.len() > 1)
        .map(|(label, press)| {
            let paired = presses.iter().find(|paired| paired.name == press.name);
            PressSeries {
                label: label.into(),
                name: press.name.clone(),
                nearest_in_contact_percent: error(press),
                taxels: evaluation.taxels.clone(),
                time_s: press.time_s.clone(),
                sensor_kpa: press.measured_kpa.clone(),
                twin_kpa: press.predicted_kpa.clone(),
                depth_mm: press.depth_mm.clone(),
                sensor_force_n: paired
                    .and_then(|p| p.measured_force_n.clone())
                    .unwrap_or_default(),
                twin_force_n: paired.map(|p| p.features.force_n.clone()).unwrap_or_default(),
            }
        })
        .collect()
}

/// Pressure maps at the peaks of the same presses.
pub(crate) fn peaks(evaluation: &Evaluation, sensor: &Sensor) -> Vec<PressPeak> {
    three(evaluation)
        .into_iter()
        .filter_map(|(label, press)| {
            let total = |row: &Vec<f64>| row.iter().sum::<f64>();
            let frame = (0..press.time_s.len())
                .max_by(|&a, &b| total(&press.measured_kpa[a]).total_cmp(&total(&press.measured_kpa[b])))?;
            Some(PressPeak {
                name: format!("{label}: {}, {:.2} mm deep", press.name, press.depth_mm[frame]),
                gel_mm: window(sensor),
                taxels_mm: taxels_mm(sensor),
                sensor_kpa: press.measured_kpa[frame].clone(),
                twin_kpa: press.predicted_kpa[frame].clone(),
                indenter_mm: Some((press.place_mm, 1.0)),
            })
        })
        .collect()
}

/// The part of the gel around the taxels: a long strip is not shown whole.
fn window(sensor: &Sensor) -> Rectangle {
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let margin_mm = high.z;
    let taxels = taxels_mm(sensor);
    let fold =
        |axis: usize, pick: fn(f64, f64) -> f64, start: f64| taxels.iter().map(|t| t[axis]).fold(start, pick);
    let side = |axis: usize, low: f64, high: f64| {
        let from = fold(axis, f64::min, f64::INFINITY) - margin_mm;
        let to = fold(axis, f64::max, f64::NEG_INFINITY) + margin_mm;
        (from.max(low), to.min(high))
    };
    let ((x0, x1), (y0, y1)) = (side(0, low.x, high.x), side(1, low.y, high.y));
    Rectangle {
        min_mm: [x0, y0],
        max_mm: [x1, y1],
    }
}

fn taxels_mm(sensor: &Sensor) -> Vec<[f64; 2]> {
    sensor
        .taxels
        .iter()
        .map(|taxel| [taxel.position_mm.x, taxel.position_mm.y])
        .collect()
}

/// Errors over the gel, for static presses.
pub(crate) fn places(evaluation: &Evaluation, sensor: &Sensor) -> Option<PlaceErrors> {
    let is_static = evaluation.presses.iter().all(|press| press.time_s.len() == 1);
    let touched = ranked(evaluation);
    (is_static && !touched.is_empty()).then(|| PlaceErrors {
        places_mm: touched.iter().map(|press| press.place_mm).collect(),
        nearest_percent: touched.iter().map(|press| error(press)).collect(),
        all_percent: touched.iter().map(|press| press.errors.all.percent).collect(),
        taxels_mm: taxels_mm(sensor),
    })
}

/// Usable readings, measured and predicted, thinned evenly.
pub(crate) fn agreement(evaluation: &Evaluation) -> Agreement {
    let mut agreement = Agreement::default();
    for press in &evaluation.presses {
        for ((measured, predicted), valid) in press
            .measured_kpa
            .iter()
            .zip(&press.predicted_kpa)
            .zip(&press.valid)
        {
            for taxel in (0..measured.len()).filter(|&taxel| valid[taxel]) {
                agreement.measured_kpa.push(measured[taxel]);
                agreement.predicted_kpa.push(predicted[taxel]);
            }
        }
    }
    let step = agreement.measured_kpa.len().div_ceil(MOST_READINGS).max(1);
    agreement.measured_kpa = agreement.measured_kpa.into_iter().step_by(step).collect();
    agreement.predicted_kpa = agreement.predicted_kpa.into_iter().step_by(step).collect();
    agreement
}

/// Mean signed error of a taxel, % of the largest reading of all presses shown.
pub(crate) fn bias_percent(evaluation: &Evaluation, taxel: usize) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for press in &evaluation.presses {
        for ((measured, predicted), valid) in press
            .measured_kpa
            .iter()
            .zip(&press.predicted_kpa)
            .zip(&press.valid)
        {
            if valid[taxel] {
                sum += predicted[taxel] - measured[taxel];
                count += 1.0;
            }
        }
    }
    100.0 * sum / count.max(1.0) / largest_kpa(evaluation)
}

fn largest_kpa(evaluation: &Evaluation) -> f64 {
    let readings = evaluation
        .presses
        .iter()
        .flat_map(|press| press.measured_kpa.iter().flatten());
    readings.fold(f64::MIN_POSITIVE, |largest, reading| largest.max(*reading))
}

/// Errors of the nearest taxel by depth, % of the largest reading of all presses shown.
pub(crate) fn depths(evaluation: &Evaluation, left_out: &BTreeSet<usize>) -> Vec<DepthError> {
    let deepest_mm = evaluation
        .presses
        .iter()
        .flat_map(|p| &p.depth_mm)
        .fold(0.0, |deepest: f64, d| deepest.max(*d));
    if deepest_mm <= 0.0 || evaluation.presses.iter().all(|press| press.time_s.len() == 1) {
        return Vec::new();
    }
    let largest_kpa = largest_kpa(evaluation);
    let mut bins = [(0.0, 0_usize); DEPTH_BINS];
    for press in &evaluation.presses {
        for (frame, depth_mm) in press
            .depth_mm
            .iter()
            .enumerate()
            .filter(|(_, depth)| **depth > 0.0)
        {
            let measured = &press.measured_kpa[frame];
            let usable = (0..measured.len()).filter(|t| press.valid[frame][*t] && !left_out.contains(t));
            let nearest = usable.max_by(|&a, &b| measured[a].total_cmp(&measured[b]));
            if let Some(taxel) = nearest.filter(|&taxel| measured[taxel] > CONTACT_SHARE * largest_kpa) {
                let bin = ((depth_mm / deepest_mm * DEPTH_BINS as f64) as usize).min(DEPTH_BINS - 1);
                bins[bin].0 += (press.predicted_kpa[frame][taxel] - measured[taxel]).abs();
                bins[bin].1 += 1;
            }
        }
    }
    let width_mm = deepest_mm / DEPTH_BINS as f64;
    bins.iter()
        .enumerate()
        .filter(|(_, (_, frames))| *frames > 0)
        .map(|(bin, (sum, frames))| DepthError {
            from_mm: bin as f64 * width_mm,
            to_mm: (bin + 1) as f64 * width_mm,
            nearest_in_contact_percent: 100.0 * sum / *frames as f64 / largest_kpa,
            frames: *frames,
        })
        .collect()
}
