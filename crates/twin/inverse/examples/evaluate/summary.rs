//! Summary of all presses.

use std::collections::BTreeMap;

use serde::Serialize;
use twintac_inverse::{InverseSettings, KnownShape};

use crate::held::Watched;

/// The complete result.
#[derive(Serialize)]
pub(crate) struct Evaluation {
    pub(crate) command: String,
    pub(crate) provenance: String,
    pub(crate) sensor: String,
    pub(crate) settings: InverseSettings,
    pub(crate) n_presses: usize,
    /// Time to prepare seven shapes, s.
    pub(crate) prepared_s: f64,
    pub(crate) shapes_to_tell: Summary,
    pub(crate) shape_given: Summary,
    /// Median, 99th percentile, and median of first frames in contact, for seven shapes on one
    /// core.
    pub(crate) microseconds_a_frame: [f64; 3],
}

/// Results by groups of steps.
#[derive(Serialize)]
pub(crate) struct Summary {
    all: Group,
    over_the_taxels: Group,
    outside_the_taxels: Group,
    down_to_1_mm: Group,
    below_1_mm: Group,
    deepest_steps: Group,
    by_shape: BTreeMap<String, Group>,
    /// For each true shape, how often each shape was found at the deepest step.
    told_at_deepest: BTreeMap<String, BTreeMap<String, usize>>,
}

/// Median errors.
#[derive(Serialize)]
pub(crate) struct Group {
    n: usize,
    place_mm: f64,
    place_90_percent_mm: f64,
    map_peak_mm: f64,
    force_percent: f64,
    depth_percent: f64,
    shape_told_percent: f64,
    floor_percent: f64,
    interpolated_floor_percent: f64,
    /// How often errors of x, y, depth and force are within two of the estimated deviations, %.
    within_two_deviations_percent: [f64; 4],
}

pub(crate) fn summary(shapes: &[KnownShape], watched: &[Watched]) -> Summary {
    let group = |is_in: &dyn Fn(&Watched) -> bool| group(watched.iter().filter(|found| is_in(found)));
    let deepest = watched.iter().map(|found| found.step).max().unwrap_or(0);
    let named = |number: usize| shapes[number].name.clone();
    let mut told_at_deepest: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    for found in watched.iter().filter(|found| found.step == deepest) {
        let told = told_at_deepest.entry(named(found.shape)).or_default();
        *told.entry(named(found.told)).or_default() += 1;
    }
    Summary {
        all: group(&|_| true),
        over_the_taxels: group(&|found| found.is_over_taxels),
        outside_the_taxels: group(&|found| !found.is_over_taxels),
        down_to_1_mm: group(&|found| found.depth_mm <= 1.0),
        below_1_mm: group(&|found| found.depth_mm > 1.0),
        deepest_steps: group(&|found| found.step == deepest),
        by_shape: (0..shapes.len())
            .map(|shape| (named(shape), group(&|found| found.shape == shape)))
            .collect(),
        told_at_deepest,
    }
}

fn group<'a>(found: impl Iterator<Item = &'a Watched>) -> Group {
    let found: Vec<&Watched> = found.collect();
    let quantile = |part: f64, value: &dyn Fn(&Watched) -> f64| {
        let mut values: Vec<f64> = found.iter().map(|found| value(found)).collect();
        values.sort_by(f64::total_cmp);
        let value = values.get((part * values.len() as f64) as usize).copied();
        (1e3 * value.unwrap_or(0.0)).round() / 1e3
    };
    let percent = |is: &dyn Fn(&Watched) -> bool| {
        let n = found.iter().filter(|found| is(found)).count();
        (1e3 * n as f64 / found.len().max(1) as f64).round() / 10.0
    };
    Group {
        n: found.len(),
        place_mm: quantile(0.5, &|found| found.place_error_mm),
        place_90_percent_mm: quantile(0.9, &|found| found.place_error_mm),
        map_peak_mm: quantile(0.5, &|found| found.peak_error_mm),
        force_percent: quantile(0.5, &|found| found.force_percent),
        depth_percent: quantile(0.5, &|found| found.depth_percent),
        shape_told_percent: percent(&|found| found.told == found.shape),
        floor_percent: quantile(0.5, &|found| found.floor_percent[0]),
        interpolated_floor_percent: quantile(0.5, &|found| found.floor_percent[1]),
        within_two_deviations_percent: [0, 1, 2, 3]
            .map(|number| percent(&|found| found.over_deviation[number].abs() < 2.0)),
    }
}
