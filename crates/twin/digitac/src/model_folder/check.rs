//! Whether a model's record can be used: every number is finite and within a plausible range, and
//! every list has one value for each taxel.

use twintac_config::{Checked, Ranges};

use super::ModelRecord;
use super::record::Start;
use crate::bench_fit::N_SMOOTH_TERMS;
use crate::network::Normalization;
use crate::training::{MOST_LAYERS, MOST_WIDTH};
use crate::{BenchEstimate, Estimate, Gains, PortEstimate, SmoothFactor};

/// Largest number of taxels of a sensor.
const MOST_TAXELS: usize = 10_000;
/// Largest coefficient, gain or growth: far beyond learned values, and far from overflow in
/// products.
const COEFFICIENT: f64 = 1e6;
/// Smallest value of numbers that are divided by.
const SMALLEST: f64 = 1e-30;

impl Checked for ModelRecord {
    fn check(&self, ranges: &mut Ranges) {
        let n_taxels = self.taxels.len();
        let is_right = (1..=MOST_TAXELS).contains(&n_taxels);
        let problem = || format!("names {n_taxels} taxels");
        ranges.that("taxels", is_right, problem, || {
            format!("1 to {MOST_TAXELS} can be")
        });
        ranges.inside("start", &Of(&self.start, n_taxels));
        ranges.inside("gains", &Of(&self.gains, n_taxels));
        ranges.inside("bench", &Of(&self.bench, n_taxels));
        if let Some(temperature) = &self.temperature {
            ranges.inside("temperature", temperature);
        }
        if let Some(certainty) = &self.certainty {
            ranges.inside("certainty", certainty);
        }
    }
}

/// A part of the record, with the number of taxels of its sensor.
struct Of<'a, T>(&'a T, usize);

fn count<T>(ranges: &mut Ranges, field: &str, values: &[T], expected: usize, of: &str) {
    ranges.that(
        field,
        values.len() == expected,
        || format!("has {} entries", values.len()),
        || format!("one for each of {expected} {of} is expected"),
    );
}

impl Checked for Of<'_, Start> {
    fn check(&self, ranges: &mut Ranges) {
        let Self(start, n_taxels) = *self;
        let Start {
            gains,
            normalization,
            correction_limit,
            hidden,
        } = start;
        ranges.inside("gains", &Of(gains, n_taxels));
        ranges.inside("normalization", &Of(normalization, n_taxels));
        ranges.number("correction_limit", *correction_limit, 0.0..=10.0);
        ranges.numbers("hidden", hidden, MOST_LAYERS, 1.0..=MOST_WIDTH);
    }
}

impl Checked for Of<'_, Gains> {
    fn check(&self, ranges: &mut Ranges) {
        let Self(gains, n_taxels) = *self;
        let Gains {
            gain,
            stiffening_per_kpa,
            memory,
            time_constants_s,
        } = gains;
        for (field, values) in [("gain", gain), ("stiffening_per_kpa", stiffening_per_kpa)] {
            count(ranges, field, values, n_taxels, "taxels");
            ranges.numbers(field, values, MOST_TAXELS, -COEFFICIENT..=COEFFICIENT);
        }
        ranges.numbers("time_constants_s", time_constants_s, 16, 1e-6..=1e9);
        count(ranges, "memory", memory, n_taxels, "taxels");
        for (taxel, shares) in memory.iter().enumerate() {
            let field = format!("memory[{taxel}]");
            count(ranges, &field, shares, time_constants_s.len(), "time constants");
            ranges.numbers(&field, shares, 16, -COEFFICIENT..=COEFFICIENT);
        }
    }
}

impl Checked for Of<'_, Normalization> {
    fn check(&self, ranges: &mut Ranges) {
        let Self(normalization, n_taxels) = *self;
        let Normalization {
            reading_kpa,
            pressure_rms_kpa,
            stress_mean_kpa_per_mm,
            stress_deviation_kpa_per_mm,
        } = normalization;
        ranges.number("reading_kpa", *reading_kpa, SMALLEST..=1e9);
        for (field, values, least) in [
            ("pressure_rms_kpa", pressure_rms_kpa, SMALLEST),
            ("stress_mean_kpa_per_mm", stress_mean_kpa_per_mm, -1e9),
            (
                "stress_deviation_kpa_per_mm",
                stress_deviation_kpa_per_mm,
                SMALLEST,
            ),
        ] {
            count(ranges, field, values, n_taxels, "taxels");
            ranges.numbers(field, values, MOST_TAXELS, least..=1e9);
        }
    }
}

impl Checked for Of<'_, BenchEstimate> {
    fn check(&self, ranges: &mut Ranges) {
        let Self(bench, n_taxels) = *self;
        let BenchEstimate {
            tip_radius_mm,
            contact_offset_mm,
            contact_offset_elsewhere_mm,
            stiffness,
            ports,
            smooth_factor,
            has_history: _,
            gains,
            deviation_percent,
            doubts: _,
        } = bench;
        if let Some(Estimate { value, .. }) = tip_radius_mm {
            ranges.number("tip_radius_mm.value", *value, 1e-3..=1e3);
        }
        for (mounting, Estimate { value, .. }) in contact_offset_mm {
            let field = format!("contact_offset_mm.{mounting}.value");
            ranges.number(&field, *value, -50.0..=50.0);
        }
        let elsewhere_mm = *contact_offset_elsewhere_mm;
        ranges.number("contact_offset_elsewhere_mm", elsewhere_mm, -50.0..=50.0);
        if let Some(Estimate { value, .. }) = stiffness {
            ranges.number("stiffness.value", *value, 1e-3..=1e3);
        }
        if !ports.is_empty() {
            count(ranges, "ports", ports, n_taxels, "taxels");
        }
        for (port, PortEstimate { shift_mm, wider_mm }) in ports.iter().enumerate() {
            ranges.numbers(&format!("ports[{port}].shift_mm"), shift_mm, 2, -50.0..=50.0);
            ranges.number(&format!("ports[{port}].wider_mm"), *wider_mm, -50.0..=50.0);
        }
        if let Some(factor) = smooth_factor {
            ranges.inside("smooth_factor", &Of(factor, n_taxels));
        }
        if let Some(gains) = gains {
            ranges.inside("gains", &Of(gains, n_taxels));
        }
        ranges.number("deviation_percent", *deviation_percent, 0.0..=1e9);
    }
}

impl Checked for Of<'_, SmoothFactor> {
    fn check(&self, ranges: &mut Ranges) {
        let Self(factor, n_taxels) = *self;
        let SmoothFactor {
            ports_mm,
            reach_mm,
            depth_mm,
            coefficients,
        } = factor;
        count(ranges, "ports_mm", ports_mm, n_taxels, "taxels");
        for (port, place_mm) in ports_mm.iter().enumerate() {
            ranges.numbers(&format!("ports_mm[{port}]"), place_mm, 2, -1e4..=1e4);
        }
        ranges.number("reach_mm", *reach_mm, 1e-6..=1e6);
        ranges.number("depth_mm", *depth_mm, 1e-6..=1e6);
        count(ranges, "coefficients", coefficients, N_SMOOTH_TERMS, "terms");
        ranges.numbers("coefficients", coefficients, N_SMOOTH_TERMS, -100.0..=100.0);
    }
}
