//! The zero of each taxel before each press.

use std::ops::Range;

use super::description::Description;
use super::track::Track;

/// Mean reading of each taxel in the last frames before the tip is near the gel, kPa; `[n_taxels]`.
///
/// A taxel without a usable reading there has no zero. `None` if there is no frame at all. Without
/// a rule the zero is 0.
pub(crate) fn before_press(
    track: &Track,
    span: Range<usize>,
    description: &Description,
) -> Option<Vec<Option<f64>>> {
    let taxels = 0..description.taxels.len();
    let Some(zero) = description.zero else {
        return Some(vec![Some(0.0); taxels.len()]);
    };
    let away: Vec<usize> = span
        .take_while(|&row| track.height_mm[row] >= zero.above_contact_mm)
        .collect();
    let from_s = track.time_s[*away.last()?] - zero.window_s;
    let window: Vec<usize> = away
        .into_iter()
        .filter(|&row| track.time_s[row] >= from_s)
        .collect();
    let mean_kpa = |taxel: usize| {
        let usable = window.iter().filter(|&&row| track.usable[taxel][row]);
        let (sum, count) = usable.fold((0.0, 0), |(sum, count), &row| {
            (sum + track.kpa(row, taxel, description), count + 1)
        });
        (count > 0).then(|| sum / f64::from(count))
    };
    Some(taxels.map(mean_kpa).collect())
}
