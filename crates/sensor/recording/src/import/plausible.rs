//! Checks that presses and readings are plausible for the description. Implausible ones would give
//! meaningless results.

use std::ops::Range;

use super::description::{Description, Split};
use super::track::Track;
use crate::RecordingError;

/// Absolute readings of an untouched sensor are in this range: atmospheric pressure, kPa.
pub(super) const AIR_KPA: Range<f64> = 80.0..115.0;

/// Refuses a file in which no press reaches the gel, and readings near atmospheric pressure from
/// which no zero is subtracted.
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
    // A dead weight lies on the gel and has no approach.
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
            let median_kpa = track.median_kpa(taxel, description);
            if let Some(median_kpa) = median_kpa.filter(|kpa| AIR_KPA.contains(kpa)) {
                let hint = if matches!(description.presses, Split::Row) {
                    "subtract its untouched reading with `offset_kpa`"
                } else {
                    "give `zero`, which says from which frames before each press its untouched reading is taken"
                };
                return refuse(format!(
                    "the readings of `{}` have a median of {median_kpa:.1} kPa, the pressure of the air, but readings are relative to it; {hint}",
                    line.name
                ));
            }
        }
    }
    Ok(())
}
