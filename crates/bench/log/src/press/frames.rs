//! One press, frame by frame.

use twintac_recording::Press;

use super::ReadOptions;
use super::baseline::{baseline_pa, pressure_pa};
use super::collect::Collected;
use crate::{Description, TactileFrame, TaxelReading};

/// The press with an index among the log's presses. `None` if it has no frame.
pub(super) fn press(
    collected: &Collected,
    description: &Description,
    place: usize,
    file: &str,
    options: &ReadOptions,
    remarks: &mut Vec<String>,
) -> Option<Press> {
    let span = &collected.spans[place];
    let frames = &collected.frames;
    let first = frames.partition_point(|(time_ns, _)| *time_ns < span.from_ns);
    let behind = frames
        .partition_point(|(time_ns, _)| *time_ns <= span.to_ns)
        .max(first);
    let frames = &frames[first..behind];
    if frames.is_empty() {
        remarks.push(format!(
            "press `{}` has no tactile frames and is left out",
            span.name
        ));
        return None;
    }
    let window_ns = options.baseline_ms.saturating_mul(1_000_000);
    let baselines_pa = baseline_pa(collected, place, description.taxels.len(), window_ns);
    for (taxel, _) in description
        .taxels
        .iter()
        .zip(&baselines_pa)
        .filter(|(_, baseline)| baseline.is_none())
    {
        remarks.push(format!(
            "press `{}`: taxel `{taxel}` has no baseline and is invalid",
            span.name
        ));
    }
    let has_force = !collected.force_n.is_empty();
    let mut press = Press {
        name: span.name.clone(),
        mounting: file.to_owned(),
        indenter: span.indenter.clone(),
        control: span.control,
        time_s: frames.iter().map(|(time_ns, _)| *time_ns as f64 * 1e-9).collect(),
        gel_from_indenter: Vec::with_capacity(frames.len()),
        force_n: has_force.then(|| Vec::with_capacity(frames.len())),
        taxels_kpa: Vec::with_capacity(frames.len()),
        taxels_raw: Vec::with_capacity(frames.len()),
        temperature_c: temperatures_c(frames),
        valid: Vec::with_capacity(frames.len()),
    };
    for (time_ns, frame) in frames {
        let pose = collected.poses.at(*time_ns);
        let force_n = collected.force_n.at(*time_ns);
        let is_placed = pose.is_some() && force_n.is_some() == has_force;
        let pose = pose.or_else(|| collected.poses.nearest(*time_ns));
        press
            .gel_from_indenter
            .push(pose.expect("a log without poses has no presses"));
        if let Some(forces_n) = &mut press.force_n {
            let force_n = force_n.or_else(|| collected.force_n.nearest(*time_ns));
            forces_n.push(force_n.expect("the log has wrenches"));
        }
        let taxels = || frame.taxels.iter().zip(&baselines_pa);
        let above = |(taxel, baseline_pa): (&TaxelReading, &Option<f64>)| {
            Some((pressure_pa(taxel)? - (*baseline_pa)?) / 1000.0)
        };
        let readings_kpa: Vec<Option<f64>> = taxels().map(above).collect();
        press.valid.push(
            readings_kpa
                .iter()
                .map(|reading| is_placed && reading.is_some())
                .collect(),
        );
        press
            .taxels_kpa
            .push(readings_kpa.into_iter().map(known_or_nan).collect());
        press.taxels_raw.push(frame.taxels.iter().map(raw).collect());
    }
    for (taxel, name) in description.taxels.iter().enumerate() {
        let n_missing = press.taxels_raw.iter().filter(|row| row[taxel].is_nan()).count();
        if n_missing > 0 {
            let n_frames = press.time_s.len();
            remarks.push(format!(
                "press `{}`: taxel `{name}` has no reading in {n_missing} of {n_frames} frames",
                span.name
            ));
        }
    }
    Some(press)
}

/// Temperatures of the taxels in each frame, if any gave one.
fn temperatures_c(frames: &[(u64, TactileFrame)]) -> Option<Vec<Vec<f64>>> {
    let known = |taxel: &TaxelReading| known_or_nan(taxel.temperature_c.filter(|c| c.is_finite()));
    let rows = frames
        .iter()
        .map(|(_, frame)| frame.taxels.iter().map(known).collect());
    let rows: Vec<Vec<f64>> = rows.collect();
    rows.iter().flatten().any(|c| !c.is_nan()).then_some(rows)
}

/// The reading of the taxel in its own unit. NaN if there is none.
fn raw(taxel: &TaxelReading) -> f64 {
    let raw = taxel.counts.map(f64::from).or(taxel.pressure_pa);
    known_or_nan(raw.filter(|raw| raw.is_finite()))
}

fn known_or_nan(reading: Option<f64>) -> f64 {
    reading.unwrap_or(f64::NAN)
}
