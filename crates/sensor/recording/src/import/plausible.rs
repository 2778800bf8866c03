//! Whether presses and readings can be what the description says: what is not would end as figures that mean nothing.

use std::ops::Range;

use super::description::{Description, Split};
use super::track::Track;
use crate::RecordingError;

/// Readings between these are absolute ones of an untouched sensor: the pressure of the air, kPa.
const AIR_KPA: Range<f64> = 80.0..115.0;

/// Refuses presses of which none reaches the gel, and readings of about the pressure of the air that nothing is taken off.
pub(crate) fn check(
    file: &str,
    track: &Track,
    presses: &[Range<usize>],
    description: &Description,
) -> Result<(), RecordingError> {
    let refuse = |problem: String| {
        Err(RecordingError::Implausible {
            file: file.to_owned(),
            problem,
        })
    };
    // A dead weight lies on the gel; rows have no way down.
    let has_heights = description.z.is_some() && description.weight_n.is_none() && !presses.is_empty();
    let rows = presses.iter().cloned().flatten();
    let deepest_mm = rows.map(|row| track.height_mm[row]).fold(f64::INFINITY, f64::min);
    if has_heights && deepest_mm > 0.0 {
        return refuse(format!(
            "no press reaches the gel: the deepest is {deepest_mm:.3} mm above it; `contact.z_mm`, `contact.z_points` and the unit of `z` say where the gel is"
        ));
    }
    if description.zero.is_none() {
        for (taxel, line) in description.taxels.iter().enumerate() {
            let mut kpa: Vec<f64> = (0..track.time_s.len())
                .filter(|&row| track.usable[taxel][row])
                .map(|row| track.kpa(row, taxel, description))
                .collect();
            let middle = kpa.len() / 2;
            if kpa.is_empty() {
                continue;
            }
            let (_, median_kpa, _) = kpa.select_nth_unstable_by(middle, f64::total_cmp);
            if AIR_KPA.contains(median_kpa) {
                let hint = if matches!(description.presses, Split::Row) {
                    "take its reading without touch off with `offset_kpa`"
                } else {
                    "give `zero`, from which frames before each press its reading without touch is taken"
                };
                return refuse(format!(
                    "the readings of `{}` have a median of {median_kpa:.1} kPa, the pressure of the air, and readings are what touch adds to it; {hint}",
                    line.name
                ));
            }
        }
    }
    Ok(())
}
