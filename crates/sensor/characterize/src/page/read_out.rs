//! Figures of the read-out, as rows of the data sheet.

use super::words::{if_found, number, or_not, row};
use crate::{Characterization, Fate};

/// Name, value and condition of each figure.
pub(super) fn rows(found: &Characterization) -> Vec<[String; 3]> {
    let silent = found.conditions.iter().filter(|taxel| taxel.n_missing > 0);
    let silent = silent.map(|taxel| {
        format!(
            "{} in {} of {} frames",
            taxel.taxel, taxel.n_missing, taxel.n_frames
        )
    });
    let silent: Vec<String> = silent.collect();
    let with = |fate: Fate| found.conditions.iter().filter(|taxel| taxel.fate == fate).count();
    vec![
        row(
            "Frames",
            or_not(&found.timing, |timing| {
                let (rate_hz, jitter) = (
                    number(timing.rate_hz, 3),
                    number(100.0 * above_rounding(timing.jitter), 2),
                );
                format!("{rate_hz} Hz, jitter {jitter} %")
            }),
            if_found(&found.timing, |timing| {
                let (all, gaps) = (timing.n_intervals, timing.n_gaps);
                format!("mean and standard deviation of {all} intervals between frames, without {gaps} gaps")
            }),
        ),
        row(
            "Step of readings",
            or_not(&found.quantum, |quantum| {
                format!("{} kPa", number(quantum.step_kpa, 3))
            }),
            "smallest difference of which the others are multiples".into(),
        ),
        row(
            "Taxels that fail",
            format!(
                "{} dead, {} stuck, {} late, {} intermittent",
                with(Fate::Dead),
                with(Fate::Stuck),
                with(Fate::Late),
                with(Fate::Intermittent)
            ),
            match silent.is_empty() {
                true => format!("of {}", found.conditions.len()),
                false => format!(
                    "of {}; no readings of {}",
                    found.conditions.len(),
                    silent.join(", ")
                ),
            },
        ),
    ]
}

/// The jitter, or 0 if it is so small that rounding of the time stamps explains it.
fn above_rounding(jitter: f64) -> f64 {
    if jitter < 1e-9 { 0.0 } else { jitter }
}
