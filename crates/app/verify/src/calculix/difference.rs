//! Differences of two values, in percent.

/// Part of the largest pressure at a taxel above which errors are relative to the taxel's own pressure.
const MEANINGFUL: f64 = 0.05;

/// Difference of two pressures, %: relative to the second one where that is meaningful, else to the largest of all taxels.
pub(super) fn pressure_percent(pair: [f64; 2], largest_kpa: f64) -> f64 {
    let is_meaningful = pair[1].abs() > MEANINGFUL * largest_kpa;
    percent(pair, if is_meaningful { pair[1].abs() } else { largest_kpa })
}

/// Difference of two values as part of a whole, %.
pub(super) fn percent([ours, theirs]: [f64; 2], whole: f64) -> f64 {
    100.0 * (ours - theirs) / whole
}
