//! Dynamic time warping of a measured load onto a simulated one.
//!
//! Both loads are sampled at the same instants, so the path would be the diagonal if the clocks
//! agreed. The *rates* of the loads are compared (derivative dynamic time warping, Keogh and
//! Pazzani, SDM 2001): the instants at which a load begins to rise or fall are the same on both
//! sides, while its level also shows relaxation and hysteresis, which the warp must not remove.
//! Steps off the diagonal have a cost, so plateaus and noise are not moved. A Sakoe-Chiba window
//! bounds the shift of any instant. A warp that does not remove most of the mismatch is rejected.

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, Ranges};

/// Settings of the time warp.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WarpSettings {
    /// Half-width of the Sakoe-Chiba window, s. Zero disables the warp.
    pub window_s: f64,
    /// Cost of each step off the diagonal, in units of the largest rate.
    pub step_cost: f64,
    /// Half-width over which rates are averaged, s.
    pub smoothing_s: f64,
    /// A warp is rejected if its cost is above this fraction of the cost without a warp.
    pub believed_below: f64,
}

impl Default for WarpSettings {
    fn default() -> Self {
        Self {
            window_s: 0.25,
            step_cost: 0.3,
            smoothing_s: 0.08,
            believed_below: 0.5,
        }
    }
}

impl Checked for WarpSettings {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            window_s,
            step_cost,
            smoothing_s,
            believed_below,
        } = self;
        ranges.zero_or("window_s", *window_s, 1e-3..=10.0);
        ranges.zero_or("step_cost", *step_cost, 1e-6..=1e3);
        ranges.zero_or("smoothing_s", *smoothing_s, 1e-3..=10.0);
        ranges.zero_or("believed_below", *believed_below, 1e-3..=1.0);
    }
}

/// The time of each simulated frame on the measurement's clock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Warp {
    /// For each simulated frame, the fractional index of the measured frame that belongs to it;
    /// `[n_frames]`.
    pub measured_index: Vec<f64>,
    /// Accumulated cost of the path, in units of the largest rate.
    pub cost: f64,
    /// Largest time by which a frame was moved, s.
    pub largest_shift_s: f64,
}

impl Warp {
    /// The warp that changes nothing.
    #[must_use]
    pub fn identity(n_frames: usize) -> Self {
        Self {
            measured_index: (0..n_frames).map(|i| i as f64).collect(),
            cost: 0.0,
            largest_shift_s: 0.0,
        }
    }

    /// Finds the warp between two loads in any units, both `[n_frames]` at the instants `time_s`.
    /// If a load never rises, the warp is the identity.
    #[must_use]
    pub fn between(time_s: &[f64], measured: &[f64], simulated: &[f64], settings: &WarpSettings) -> Self {
        let n = time_s.len();
        let flat = |load: &[f64]| load.iter().fold(0.0_f64, |a, b| a.max(*b)) <= 0.0;
        if n < 3 || measured.len() != n || simulated.len() != n || settings.window_s <= 0.0 {
            return Self::identity(n);
        }
        if flat(measured) || flat(simulated) {
            return Self::identity(n);
        }
        let measured = normalized_rate(time_s, measured, settings.smoothing_s);
        let simulated = normalized_rate(time_s, simulated, settings.smoothing_s);
        let (path, cost) = cheapest_path(time_s, &measured, &simulated, settings);
        let straight_cost: f64 = measured.iter().zip(&simulated).map(|(a, b)| (a - b).abs()).sum();
        if cost > settings.believed_below * straight_cost {
            return Self {
                cost: straight_cost,
                ..Self::identity(n)
            };
        }
        Self::from_path(time_s, &path, cost)
    }

    fn from_path(time_s: &[f64], path: &[(usize, usize)], cost: f64) -> Self {
        let n = time_s.len();
        let (mut sum, mut count) = (vec![0.0; n], vec![0.0; n]);
        for &(i, j) in path {
            sum[j] += i as f64;
            count[j] += 1.0;
        }
        let measured_index: Vec<f64> = sum.iter().zip(&count).map(|(s, c)| s / c).collect();
        let largest_shift_s = measured_index
            .iter()
            .zip(time_s)
            .map(|(&index, now)| (interpolate(time_s, index) - now).abs())
            .fold(0.0, f64::max);
        Self {
            measured_index,
            cost,
            largest_shift_s,
        }
    }

    /// Interpolates rows on the measurement's clock at the simulated frames;
    /// `[n_frames][n_columns]`.
    #[must_use]
    pub fn apply(&self, rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.measured_index
            .iter()
            .map(|&index| {
                let ([i, next], fraction) = split(index, rows.len());
                rows[i]
                    .iter()
                    .zip(&rows[next])
                    .map(|(a, b)| a + fraction * (b - a))
                    .collect()
            })
            .collect()
    }

    /// Applies the warp to flags of usable rows: a warped row is usable where both rows that it is
    /// interpolated from are usable.
    #[must_use]
    pub(crate) fn apply_valid(&self, rows: &[Vec<bool>]) -> Vec<Vec<bool>> {
        self.measured_index
            .iter()
            .map(|&index| {
                let ([i, next], _) = split(index, rows.len());
                rows[i].iter().zip(&rows[next]).map(|(a, b)| *a && *b).collect()
            })
            .collect()
    }
}

/// The two rows around an index and the fraction of the way from the first to the second. At a row
/// itself, both are this row, because the next one may be missing.
fn split(index: f64, n: usize) -> ([usize; 2], f64) {
    let i = (index.floor() as usize).min(n - 1);
    let fraction = index - i as f64;
    let next = if fraction > 0.0 { (i + 1).min(n - 1) } else { i };
    ([i, next], fraction)
}

fn interpolate(values: &[f64], index: f64) -> f64 {
    let ([i, next], fraction) = split(index, values.len());
    values[i] + fraction * (values[next] - values[i])
}

/// Rate of a load between `smoothing_s` before and after each instant, over its largest magnitude.
fn normalized_rate(time_s: &[f64], load: &[f64], smoothing_s: f64) -> Vec<f64> {
    let n = time_s.len();
    let rate: Vec<f64> = (0..n)
        .map(|i| {
            let before = time_s
                .partition_point(|t| *t < time_s[i] - smoothing_s)
                .min(i.saturating_sub(1));
            let after = time_s
                .partition_point(|t| *t <= time_s[i] + smoothing_s)
                .clamp((i + 2).min(n), n)
                - 1;
            let duration_s = time_s[after] - time_s[before];
            if duration_s > 0.0 {
                (load[after] - load[before]) / duration_s
            } else {
                0.0
            }
        })
        .collect();
    let largest = rate.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    if largest > 0.0 {
        rate.iter().map(|r| r / largest).collect()
    } else {
        rate
    }
}

/// The cheapest sequence of pairs (measured, simulated) from the first frames to the last, and its
/// cost.
fn cheapest_path(
    time_s: &[f64],
    measured: &[f64],
    simulated: &[f64],
    settings: &WarpSettings,
) -> (Vec<(usize, usize)>, f64) {
    let n = time_s.len();
    // Row j has the measured frames i within the window of the simulated frame j. The diagonal is
    // always one of them.
    let low: Vec<usize> = time_s
        .iter()
        .map(|t| time_s.partition_point(|other| *other < t - settings.window_s))
        .collect();
    let high: Vec<usize> = time_s
        .iter()
        .map(|t| time_s.partition_point(|other| *other <= t + settings.window_s))
        .collect();
    let mut rows: Vec<Vec<(f64, Step)>> = Vec::with_capacity(n);
    for j in 0..n {
        let mut row: Vec<(f64, Step)> = Vec::with_capacity(high[j] - low[j]);
        for i in low[j]..high[j] {
            let above = |i: usize| -> f64 {
                if j > 0 && (low[j - 1]..high[j - 1]).contains(&i) {
                    rows[j - 1][i - low[j - 1]].0
                } else {
                    f64::INFINITY
                }
            };
            let diagonal = if i > 0 { above(i - 1) } else { f64::INFINITY };
            let wait = above(i) + settings.step_cost;
            let skip = if i > low[j] {
                row[i - low[j] - 1].0 + settings.step_cost
            } else {
                f64::INFINITY
            };
            let (before, step) = if i == 0 && j == 0 {
                (0.0, Step::Start)
            } else if diagonal <= wait && diagonal <= skip {
                (diagonal, Step::Diagonal)
            } else if wait <= skip {
                (wait, Step::Wait)
            } else {
                (skip, Step::Skip)
            };
            row.push((before + (measured[i] - simulated[j]).abs(), step));
        }
        rows.push(row);
    }
    let (mut i, mut j) = (n - 1, n - 1);
    let cost = rows[j][i - low[j]].0;
    let mut path = vec![(i, j)];
    loop {
        match rows[j][i - low[j]].1 {
            Step::Start => break,
            Step::Diagonal => (i, j) = (i - 1, j - 1),
            Step::Wait => j -= 1,
            Step::Skip => i -= 1,
        }
        path.push((i, j));
    }
    path.reverse();
    (path, cost)
}

#[derive(Clone, Copy)]
enum Step {
    Start,
    Diagonal,
    /// The measured frame stays while the simulation advances.
    Wait,
    /// The measurement advances while the simulated frame stays.
    Skip,
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Load over time of a press from 2 s on: 3 s down, 8 s hold, 3 s up.
    fn load(time_s: f64) -> f64 {
        ((time_s - 2.0) / 3.0)
            .min((16.0 - time_s) / 3.0)
            .clamp(0.0, 1.0)
            .powf(1.4)
    }

    fn clock() -> Vec<f64> {
        (0..300).map(|i| f64::from(i) * 0.061).collect()
    }

    #[test]
    fn loads_that_agree_are_left_alone() {
        let time_s = clock();
        let simulated: Vec<f64> = time_s.iter().map(|t| load(*t)).collect();
        let measured: Vec<f64> = simulated.iter().map(|l| 37.0 * l).collect();
        let warp = Warp::between(&time_s, &measured, &simulated, &WarpSettings::default());
        assert_eq!(warp.measured_index, Warp::identity(300).measured_index);
    }

    #[test]
    fn relaxation_is_no_delay() {
        let time_s = clock();
        let simulated: Vec<f64> = time_s.iter().map(|t| load(*t)).collect();
        let measured: Vec<f64> = time_s
            .iter()
            .map(|t| load(*t) * (0.75 + 0.25 * (-(t - 2.0).max(0.0) / 4.0).exp()))
            .collect();
        let warp = Warp::between(&time_s, &measured, &simulated, &WarpSettings::default());
        assert_eq!(warp.measured_index, Warp::identity(300).measured_index);
    }

    #[test]
    fn a_delay_is_undone_where_the_load_moves() {
        let time_s = clock();
        let delay_s = 0.183;
        let simulated: Vec<f64> = time_s.iter().map(|t| load(*t)).collect();
        let measured: Vec<f64> = time_s.iter().map(|t| load(t - delay_s)).collect();
        let warp = Warp::between(&time_s, &measured, &simulated, &WarpSettings::default());
        let rows: Vec<Vec<f64>> = measured.iter().map(|l| vec![*l]).collect();
        let straight = warp.apply(&rows);
        let error =
            |f: &dyn Fn(usize) -> f64| (0..300).map(|i| (f(i) - simulated[i]).abs()).sum::<f64>() / 300.0;
        let (before, after) = (error(&|i| measured[i]), error(&|i| straight[i][0]));
        assert!(after < 0.15 * before, "{after} of {before}");
        assert!(
            (warp.largest_shift_s - delay_s).abs() < 0.07,
            "{}",
            warp.largest_shift_s
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn the_window_is_kept_and_time_never_runs_back(seed in 0_u32..1000, window_s in 0.0_f64..0.6) {
            let time_s = clock();
            let noisy = |k: f64| -> Vec<f64> {
                time_s.iter().map(|t| load(*t) + 0.1 * (17.0 * t * k + f64::from(seed)).sin()).collect()
            };
            let settings = WarpSettings { window_s, ..WarpSettings::default() };
            let warp = Warp::between(&time_s, &noisy(1.0), &noisy(1.7), &settings);
            prop_assert!(warp.largest_shift_s <= window_s + 1e-9);
            prop_assert!(warp.measured_index.windows(2).all(|pair| pair[0] <= pair[1]));
        }
    }

    #[test]
    fn a_warped_row_is_usable_only_if_its_parents_are() {
        let warp = Warp {
            measured_index: vec![0.0, 0.5, 2.0],
            cost: 0.0,
            largest_shift_s: 0.0,
        };
        let valid = warp.apply_valid(&[vec![true], vec![false], vec![true]]);
        assert_eq!(valid, [vec![true], vec![false], vec![true]]);
    }
}
