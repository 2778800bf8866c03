//! Differences of two values, in percent.

/// A pressure error is relative to the taxel's own pressure above this fraction of the largest
/// pressure at a taxel.
const MEANINGFUL: f64 = 0.05;

/// Difference of two pressures, %: relative to the second one if that is large enough, else to the
/// largest of all taxels.
pub(super) fn pressure_percent(pair: [f64; 2], largest_kpa: f64) -> f64 {
    let is_meaningful = pair[1].abs() > MEANINGFUL * largest_kpa;
    percent(pair, if is_meaningful { pair[1].abs() } else { largest_kpa })
}

/// Difference of two values, % of a whole.
pub(super) fn percent([ours, theirs]: [f64; 2], whole: f64) -> f64 {
    100.0 * (ours - theirs) / whole
}
