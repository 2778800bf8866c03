//! A taxel's zero: its reading while nothing touches it, and its drift over time.

use serde::Serialize;

use crate::Finding;
use crate::statistics::{line, mean};
use crate::untouched::{Untouched, Window};

/// Length of the shortest log that is used, s.
const LEAST_S: f64 = 300.0;

/// The zero of a taxel over time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ZeroOverTime {
    /// The taxel's name.
    pub taxel: String,
    /// Mean reading, kPa.
    pub mean_kpa: f64,
    /// Slope of the least-squares line of readings over time, kPa/h. It includes effects of weather
    /// and temperature.
    pub drift_kpa_per_h: f64,
    /// Largest minus smallest reading, each averaged over five seconds, kPa.
    pub span_kpa: f64,
    /// Length of the log, h.
    pub hours: f64,
}

/// From each taxel's longest log.
pub(crate) fn zeros(untouched: &[Untouched], taxels: &[String]) -> Finding<Vec<ZeroOverTime>> {
    let found = untouched.iter().zip(taxels).filter_map(|(of_taxel, name)| {
        let logs = of_taxel.windows.chunk_by(|a, b| a.log == b.log);
        let longest = logs.max_by(|a, b| length_s(a).total_cmp(&length_s(b)))?;
        if length_s(longest) < LEAST_S {
            return None;
        }
        let means_kpa: Vec<f64> = longest.iter().map(|window| window.mean_kpa).collect();
        let points = longest
            .iter()
            .map(|window| [window.time_s / 3600.0, window.mean_kpa]);
        let [drift_kpa_per_h, _] = line(&points.collect::<Vec<_>>())?;
        let highest_kpa = means_kpa.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let lowest_kpa = means_kpa.iter().copied().fold(f64::INFINITY, f64::min);
        Some(ZeroOverTime {
            taxel: name.clone(),
            mean_kpa: mean(&means_kpa)?,
            drift_kpa_per_h,
            span_kpa: highest_kpa - lowest_kpa,
            hours: length_s(longest) / 3600.0,
        })
    });
    let why = format!("no log has {} min in which nothing touches", LEAST_S / 60.0);
    Finding::of_list(found.collect(), &why)
}

/// Time from the first to the last window, s.
fn length_s(windows: &[Window]) -> f64 {
    match windows {
        [first, .., last] => last.time_s - first.time_s,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::untouched;

    #[test]
    fn a_drift_of_eight_kpa_an_hour_is_found_in_the_longest_log() {
        let drifting =
            |seconds: f64| untouched(seconds, |at_s| [101.0 + 8.0 * at_s / 3600.0, 99.0], |_| f64::NAN);
        let taxels = ["a", "b"].map(str::to_owned);
        let finding = zeros(&Untouched::all(&[drifting(60.0), drifting(1800.0)], 2), &taxels);
        let found = finding.found().unwrap();
        assert!((found[0].drift_kpa_per_h - 8.0).abs() < 1e-6, "{found:?}");
        assert!((found[0].hours - 0.5).abs() < 0.01 && (found[0].span_kpa - 4.0).abs() < 0.02);
        assert!((found[0].mean_kpa - 103.0).abs() < 0.01 && found[1].drift_kpa_per_h.abs() < 1e-9);
        let short = zeros(&Untouched::all(&[drifting(60.0)], 2), &taxels);
        assert!(short.why_not().unwrap().contains("5 min"));
    }
}
