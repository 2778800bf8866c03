//! The data sheet: one page.

use twintac_plot::page::{Block, Cell, Page, Section};
use twintac_recording::Recording;
use twintac_sensor::Sensor;

use super::words::{NOT_GIVEN, if_found, number, or_not, row, span};
use super::{parts, plots, read_out};
use crate::Characterization;

/// The figures of a characterization on one page.
#[must_use]
pub(super) fn data_sheet(found: &Characterization, recording: &Recording, sensor: &Sensor) -> Page {
    let recorded = parts::recorded(found, recording, sensor);
    let plots = vec![
        plots::smallest_step(found, &recorded),
        plots::largest_force(found, recording, &recorded),
        plots::responses(found),
    ];
    let plots = parts::figures(plots, found.provenance);
    let section = |id, title, block| Section {
        id,
        title,
        blocks: vec![block],
    };
    let sections = vec![
        section("figures", "Characteristics", table(found, sensor)),
        section("plots", "Range and sensitivity", plots),
    ];
    Page {
        kind: "Data sheet".into(),
        title: found.sensor.clone(),
        badge: parts::badge(found.provenance),
        lead: vec![sensor.summary.as_str().into()],
        warnings: parts::warnings(found),
        sections,
        is_sheet: true,
    }
}

/// The figures as a table.
pub(super) fn table(found: &Characterization, sensor: &Sensor) -> Block {
    let rows = found.rows(sensor).into_iter();
    let rows = rows.map(|row| row.map(Cell::Words).to_vec()).collect();
    parts::table("", ["", "value", "condition"], rows)
}

impl Characterization {
    /// Name, value and condition of each figure, as text.
    #[must_use]
    pub fn rows(&self, sensor: &Sensor) -> Vec<[String; 3]> {
        let mut rows = described(self, sensor);
        rows.extend(response(self));
        rows.extend(smallest(self));
        rows.extend(repeats(self));
        rows.extend(over_time(self));
        rows.extend(beside(self));
        rows.extend(read_out::rows(self));
        rows
    }
}

/// Rows from the sensor's description.
fn described(found: &Characterization, sensor: &Sensor) -> Vec<[String; 3]> {
    let readout = &sensor.readout;
    vec![
        row(
            "Taxels",
            sensor.taxels.len().to_string(),
            match &found.indenters[..] {
                [] => format!("{} frames of readings alone, no presses", found.n_frames_alone),
                indenters => format!("indenters: {}", indenters.join(", ")),
            },
        ),
        row(
            "Barometers’ range",
            format!("{} to {} kPa absolute", readout.min_kpa, readout.max_kpa),
            "from the sensor’s description, not measured here".into(),
        ),
        row(
            "Resolution and rate",
            format!("{} kPa, {} Hz", readout.resolution_kpa, readout.rate_hz),
            "from the sensor’s description, not measured here".into(),
        ),
    ]
}

/// Rows on the response to force.
fn response(found: &Characterization) -> Vec<[String; 3]> {
    vec![
        row(
            "Sensitivity",
            or_not(&found.overall, |overall| {
                format!("{} kPa/N", number(overall.mean_kpa_per_n, 3))
            }),
            if_found(&found.sensitivity, |taxels| {
                let slopes = taxels.iter().map(|taxel| taxel.sensitivity_kpa_per_n);
                format!(
                    "mean of {} taxels, which have {} kPa/N",
                    taxels.len(),
                    span(slopes, 3)
                )
            }),
        ),
        row(
            "Linear range",
            or_not(&found.sensitivity, |taxels| {
                let least_n = taxels
                    .iter()
                    .map(|taxel| taxel.linear_to_n)
                    .fold(f64::INFINITY, f64::min);
                format!("0 to {} N", number(least_n, 2))
            }),
            format!(
                "within {} % of the range’s end from a least-squares line, all taxels",
                found.options.linear_percent
            ),
        ),
        row(
            "Largest force in the data",
            or_not(&found.range, |range| {
                format!(
                    "{} N, {} kPa",
                    number(range.force_n, 3),
                    number(range.reading_kpa, 3)
                )
            }),
            if_found(&found.range, |range| {
                format!(
                    "taxel {} has the largest reading; larger forces were not measured",
                    range.taxel
                )
            }),
        ),
    ]
}

/// Rows on the smallest force, and on the ratio of the largest to it.
fn smallest(found: &Characterization) -> Vec<[String; 3]> {
    let sigmas = found.options.sigmas;
    vec![
        row(
            "Noise floor",
            or_not(&found.noise, |taxels| {
                format!("{} kPa", span(taxels.iter().map(|taxel| taxel.deviation_kpa), 2))
            }),
            "standard deviation of single unloaded readings, by taxel".into(),
        ),
        row(
            "Detection limit",
            or_not(&found.detection_limit, |taxels| {
                format!("{} N", span(taxels.iter().map(|taxel| taxel.single_reading_n), 2))
            }),
            format!("{sigmas} σ of a single reading over the sensitivity, by taxel"),
        ),
        row(
            "Smallest step detected",
            or_not(&found.steps, |_| {
                found.smallest_step().map_or("none".to_owned(), |step| {
                    format!(
                        "{} N (z = {})",
                        number(step.force_n, 2),
                        number(step.z_averaged, 2)
                    )
                })
            }),
            format!(
                "known weight, mean over {} s, z ≥ {sigmas}",
                found.options.window_s
            ),
        ),
        row(
            "Dynamic range",
            or_not(&found.range, |range| {
                range
                    .dynamic_range_db
                    .map_or(NOT_GIVEN.to_owned(), |db| format!("{} dB", number(db, 2)))
            }),
            "largest force in the data over the smallest detection limit".into(),
        ),
    ]
}

/// Rows on repeatability of readings at the same force.
fn repeats(found: &Characterization) -> Vec<[String; 3]> {
    vec![
        row(
            "Hysteresis",
            or_not(&found.hysteresis, |taxels| {
                format!(
                    "{} % of full scale",
                    span(taxels.iter().map(|taxel| taxel.percent), 2)
                )
            }),
            "largest difference between unloading and loading at the same force, by taxel".into(),
        ),
        row(
            "Repeatability",
            or_not(&found.repeatability, |taxels| {
                format!(
                    "{} % of full scale",
                    span(taxels.iter().map(|taxel| taxel.percent), 2)
                )
            }),
            "largest standard deviation at the same force, by taxel".into(),
        ),
    ]
}

/// Rows on time: rise time, creep, drift.
fn over_time(found: &Characterization) -> Vec<[String; 3]> {
    vec![
        row(
            "Rise time (10–90 %)",
            or_not(&found.rise_time, |rise| {
                let shorter = if rise.is_as_fast_as_force { "at most " } else { "" };
                format!("{shorter}{} s", number(rise.rise_s, 2))
            }),
            if_found(&found.rise_time, |rise| {
                let (force_s, frame_s) = (number(rise.force_rise_s, 2), number(rise.frame_s, 2));
                let word = if rise.is_as_fast_as_force {
                    "as fast as the force"
                } else {
                    "slower than the force"
                };
                format!("{word}, which takes {force_s} s; a frame takes {frame_s} s")
            }),
        ),
        row(
            "Creep",
            or_not(&found.creep, |holds| {
                format!("{} %", span(holds.iter().map(|hold| hold.percent), 2))
            }),
            if_found(&found.creep, |holds| {
                let [from_s, to_s] = holds[0].between_s;
                format!(
                    "reading over force, from {} to {} s of a hold",
                    number(from_s, 2),
                    number(to_s, 3)
                )
            }),
        ),
    ]
}

/// Rows on effects other than the force above a taxel.
fn beside(found: &Characterization) -> Vec<[String; 3]> {
    vec![
        row(
            "Cross-talk",
            or_not(&found.cross_talk, |talk| {
                format!("at most {} %", number(talk.largest_percent, 2))
            }),
            if_found(&found.cross_talk, |talk| {
                format!("of the pressed taxel’s reading, at {} N", number(talk.force_n, 2))
            }),
        ),
        row(
            "Return to zero",
            or_not(&found.zero_return, |taxels| {
                format!("{} kPa", span(taxels.iter().map(|taxel| taxel.rms_kpa), 2))
            }),
            "root mean square over presses, by taxel".into(),
        ),
        row(
            "Zero over time",
            or_not(&found.zero, |taxels| {
                format!(
                    "{} kPa/h",
                    span(taxels.iter().map(|taxel| taxel.drift_kpa_per_h), 2)
                )
            }),
            if_found(&found.zero, |taxels| {
                format!(
                    "slope over {} h, by taxel; includes weather and temperature",
                    number(taxels[0].hours, 2)
                )
            }),
        ),
        row(
            "Drift with temperature",
            or_not(&found.temperature_drift, |taxels| {
                format!(
                    "{} kPa/K",
                    span(taxels.iter().map(|taxel| taxel.coefficient_kpa_per_k), 2)
                )
            }),
            if_found(&found.temperature_drift, |taxels| {
                let left = taxels.iter().map(|taxel| taxel.remaining_kpa);
                format!(
                    "unloaded, by taxel; {} kPa remain after compensation",
                    span(left, 2)
                )
            }),
        ),
    ]
}
