//! Splits one file into presses.

use std::ops::Range;

use super::description::Split;
use super::summary::FileSummary;
use super::track::Track;

/// Largest movement of a tip that is at rest at one location, mm.
const SAME_PLACE_MM: f64 = 0.005;

/// The rows of each press, in order.
pub(crate) fn presses(track: &Track, split: &Split, summary: &mut FileSummary) -> Vec<Range<usize>> {
    let rows = track.time_s.len();
    match split {
        Split::Row => (0..rows).map(|row| row..row + 1).collect(),
        Split::None => Vec::new(),
        Split::Column { .. } => {
            let is_same = |row: usize| {
                let [before, now] = [track.press[row - 1], track.press[row]];
                before == now || before.is_nan() && now.is_nan()
            };
            runs(rows, is_same, |row| !track.press[row].is_nan())
        }
        Split::ReturnToRest {
            rest_mm,
            tolerance_mm,
            keep_rest_s,
        } => {
            let is_away = |row: usize| (track.z_mm[row] - rest_mm).abs() > *tolerance_mm;
            let excursions = runs(rows, |row| is_away(row) == is_away(row - 1), is_away);
            let mut presses = Vec::new();
            for (index, away) in excursions.iter().enumerate() {
                let place = track.place(away.start);
                if away.start == 0 && track.height_mm[0] <= 0.0 {
                    summary.drop_press(format!(
                        "from {place}: the tip is in the gel when the file starts"
                    ));
                    continue;
                }
                if away.end == rows && track.height_mm[rows - 1] <= 0.0 {
                    summary.drop_press(format!("from {place}: the tip is in the gel when the file ends"));
                    continue;
                }
                if away.end == rows {
                    summary.warn(format!(
                        "from {place}: the file ends on the way back to rest; kept, the tip has left the gel"
                    ));
                }
                let earliest = if index == 0 { 0 } else { excursions[index - 1].end };
                let latest = excursions.get(index + 1).map_or(rows, |next| next.start);
                presses.push(with_rest(track, away, earliest..latest, *keep_rest_s));
            }
            presses
        }
    }
}

/// Adds rows at rest at the same location on both sides, up to a time. Rows between two presses may
/// belong to both.
fn with_rest(track: &Track, away: &Range<usize>, limits: Range<usize>, keep_rest_s: f64) -> Range<usize> {
    let same_place = |row: usize, as_row: usize| {
        (track.x_mm[row] - track.x_mm[as_row]).abs() <= SAME_PLACE_MM
            && (track.y_mm[row] - track.y_mm[as_row]).abs() <= SAME_PLACE_MM
    };
    let (first, last) = (away.start, away.end - 1);
    let mut start = first;
    while start > limits.start
        && same_place(start - 1, first)
        && track.time_s[first] - track.time_s[start - 1] <= keep_rest_s
    {
        start -= 1;
    }
    let mut end = away.end;
    while end < limits.end && same_place(end, last) && track.time_s[end] - track.time_s[last] <= keep_rest_s {
        end += 1;
    }
    start..end
}

/// Splits rows into ranges: `goes_on` says whether a row belongs to the range of the row before.
/// Only ranges whose first row is `wanted` are kept.
fn runs(rows: usize, goes_on: impl Fn(usize) -> bool, wanted: impl Fn(usize) -> bool) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut start = 0;
    for row in 1..=rows {
        if row == rows || !goes_on(row) {
            if wanted(start) {
                runs.push(start..row);
            }
            start = row;
        }
    }
    runs
}

/// Why there are no presses.
pub(crate) fn explain(split: &Split, summary: &FileSummary) -> String {
    let looked_for = match split {
        Split::Row => "each row is a press".to_owned(),
        Split::None => {
            "`presses.split` is \"none\": such a log has readings alone, and `twintac characterize` takes it"
                .to_owned()
        }
        Split::Column { column } => format!("a press lasts while `{column}` stays the same"),
        Split::ReturnToRest {
            rest_mm,
            tolerance_mm,
            ..
        } => {
            format!("a press lasts while z is more than {tolerance_mm} mm from its rest at {rest_mm} mm")
        }
    };
    [looked_for]
        .into_iter()
        .chain(summary.warnings.iter().cloned())
        .collect::<Vec<_>>()
        .join("; ")
}
