//! Statistics of a feature, as LeRobot uses them for normalisation.

use serde_json::{Map, Value};

use super::columns::{LeRobotColumn, LeRobotValues};

/// Names of the quantiles, and their probabilities.
const QUANTILES: [(&str, f64); 5] = [
    ("q01", 0.01),
    ("q10", 0.1),
    ("q50", 0.5),
    ("q90", 0.9),
    ("q99", 0.99),
];

/// Statistics over frames for each number of a feature.
pub(super) struct Statistics {
    /// `min`, `max`, `mean`, `std` and the quantiles, by name. NaN if there are no values.
    by_name: Vec<(&'static str, Vec<f64>)>,
    /// Number of frames.
    count: i64,
}

/// Statistics of rows of numbers without those that are NaN. Quantiles are interpolated linearly
/// between neighbours. The standard deviation is that of the rows themselves (divided by their
/// number).
pub(super) fn statistics(rows: &[Vec<f64>]) -> Statistics {
    let width = rows.first().map_or(0, Vec::len);
    let mut by_name: Vec<(&'static str, Vec<f64>)> = ["min", "max", "mean", "std"]
        .into_iter()
        .chain(QUANTILES.iter().map(|(name, _)| *name))
        .map(|name| (name, Vec::with_capacity(width)))
        .collect();
    for number in 0..width {
        let all = rows.iter().map(|row| row[number]);
        let mut sorted: Vec<f64> = all.filter(|value| !value.is_nan()).collect();
        if sorted.is_empty() {
            by_name.iter_mut().for_each(|(_, values)| values.push(f64::NAN));
            continue;
        }
        sorted.sort_unstable_by(f64::total_cmp);
        let n = sorted.len() as f64;
        let mean = sorted.iter().sum::<f64>() / n;
        let variance = sorted.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n;
        let found = [sorted[0], sorted[sorted.len() - 1], mean, variance.sqrt()];
        let quantiles = QUANTILES.iter().map(|(_, part)| quantile(&sorted, *part));
        for ((_, values), found) in by_name.iter_mut().zip(found.into_iter().chain(quantiles)) {
            values.push(found);
        }
    }
    Statistics {
        by_name,
        count: rows.len() as i64,
    }
}

fn quantile(sorted: &[f64], part: f64) -> f64 {
    let at = part * (sorted.len() - 1) as f64;
    let (low, high) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    low + (high - low) * at.fract()
}

impl Statistics {
    /// As in `stats.json`; null if there are no values.
    pub(super) fn json(&self) -> Value {
        let mut json: Map<String, Value> = self
            .by_name
            .iter()
            .map(|(name, values)| ((*name).to_owned(), values.clone().into()))
            .collect();
        json.insert("count".to_owned(), vec![self.count].into());
        Value::Object(json)
    }

    /// The columns of a feature's statistics in the table of episodes.
    pub(super) fn columns(feature: &str, episodes: &[Self]) -> Vec<LeRobotColumn> {
        let names = episodes.first().map_or(&[][..], |first| &first.by_name);
        let mut columns: Vec<LeRobotColumn> = names
            .iter()
            .enumerate()
            .map(|(number, (name, _))| {
                let values = episodes
                    .iter()
                    .map(|of_episode| LeRobotValues::Double(of_episode.by_name[number].1.clone()));
                LeRobotColumn::lists(&format!("stats/{feature}/{name}"), values)
            })
            .collect();
        let counts = episodes
            .iter()
            .map(|of_episode| LeRobotValues::Whole(vec![of_episode.count]));
        columns.push(LeRobotColumn::lists(&format!("stats/{feature}/count"), counts));
        columns
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_are_those_of_numpy() {
        let rows: Vec<Vec<f64>> = [3.0, 1.0, 4.0, 1.0, 5.0]
            .iter()
            .map(|value| vec![*value, -value])
            .collect();
        let json = statistics(&rows).json();
        // NumPy: mean 2.8, std 1.6, quantile([3, 1, 4, 1, 5], [0.1, 0.5, 0.9]) = 1.0, 3.0, 4.6
        let close = |name: &str, expected: f64| {
            let found = json[name][0].as_f64().unwrap();
            assert!((found - expected).abs() < 1e-12, "{name}: {found}");
        };
        close("min", 1.0);
        close("max", 5.0);
        close("mean", 2.8);
        close("std", 1.6);
        close("q10", 1.0);
        close("q50", 3.0);
        close("q90", 4.6);
        assert_eq!(json["q90"][1].as_f64(), Some(-1.0));
        assert_eq!(json["count"][0], 5);
    }

    #[test]
    fn what_is_missing_is_left_out_and_a_statistic_of_nothing_is_null() {
        let rows = [vec![f64::NAN, f64::NAN], vec![2.0, f64::NAN], vec![4.0, f64::NAN]];
        let json = statistics(&rows).json();
        let of_first = ["min", "q50", "mean", "std"].map(|name| json[name][0].as_f64().unwrap());
        assert_eq!(of_first, [2.0, 3.0, 3.0, 1.0]);
        assert!(
            ["min", "max", "mean", "std", "q99"]
                .iter()
                .all(|name| json[name][1].is_null())
        );
        assert_eq!(json["count"][0], 3, "frames, as LeRobot weighs with them");
    }
}
