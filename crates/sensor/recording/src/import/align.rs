//! Aligns lagging readings with the clock of the poses.

use super::description::Description;
use super::track::Track;

/// Takes every taxel's reading at the time of the row plus the taxel's lag, by linear
/// interpolation. Drops rows at the ends that have no reading on both sides of that time. A reading
/// is usable if both its neighbours are.
pub(crate) fn onto_pose_clock(track: Track, description: &Description) -> Track {
    let lags_s: Vec<f64> = description.taxels.iter().map(|taxel| taxel.lag_s).collect();
    if lags_s.iter().all(|&lag_s| lag_s == 0.0) {
        return track;
    }
    let (Some(&first_s), Some(&last_s)) = (track.time_s.first(), track.time_s.last()) else {
        return track;
    };
    let covered = |&row: &usize| {
        lags_s
            .iter()
            .all(|lag_s| (first_s..=last_s).contains(&(track.time_s[row] + lag_s)))
    };
    let rows: Vec<usize> = (0..track.time_s.len()).filter(covered).collect();
    let mut raw = vec![Vec::with_capacity(rows.len()); lags_s.len()];
    let mut usable = vec![Vec::with_capacity(rows.len()); lags_s.len()];
    for (taxel, lag_s) in lags_s.iter().enumerate() {
        for &row in &rows {
            let at_s = track.time_s[row] + lag_s;
            let after = track.time_s.partition_point(|&time_s| time_s < at_s);
            let before = if track.time_s[after] > at_s {
                after - 1
            } else {
                after
            };
            let span_s = track.time_s[after] - track.time_s[before];
            let share = if span_s > 0.0 {
                (at_s - track.time_s[before]) / span_s
            } else {
                0.0
            };
            let (low, high) = (track.raw[taxel][before], track.raw[taxel][after]);
            raw[taxel].push(low + share * (high - low));
            usable[taxel].push(track.usable[taxel][before] && track.usable[taxel][after]);
        }
    }
    let pick = |column: &[f64]| rows.iter().map(|&row| column[row]).collect::<Vec<f64>>();
    Track {
        row_name: track.row_name,
        lines: rows.iter().map(|&row| track.lines[row]).collect(),
        time_s: pick(&track.time_s),
        x_mm: pick(&track.x_mm),
        y_mm: pick(&track.y_mm),
        z_mm: pick(&track.z_mm),
        height_mm: pick(&track.height_mm),
        force_n: pick(&track.force_n),
        rotation: if track.rotation.is_empty() {
            Vec::new()
        } else {
            rows.iter().map(|&row| track.rotation[row]).collect()
        },
        press: if track.press.is_empty() {
            Vec::new()
        } else {
            pick(&track.press)
        },
        temperature_c: track.temperature_c.iter().map(|column| pick(column)).collect(),
        raw,
        usable,
    }
}
