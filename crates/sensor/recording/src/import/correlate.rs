//! Finds the clock of one file on that of another from the presses that both contain.

use std::collections::BTreeSet;

use super::median::median;

/// A linear relation between two clocks: `offset_s + rate · time_s`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clock {
    pub(crate) offset_s: f64,
    pub(crate) rate: f64,
}

impl Clock {
    pub(crate) fn convert(self, time_s: f64) -> f64 {
        self.offset_s + self.rate * time_s
    }
}

/// Strength of contact over time, on a file's own clock.
pub(crate) struct Activity {
    /// Times, increasing, s.
    pub(crate) time_s: Vec<f64>,
    /// Strength of contact; zero without contact.
    pub(crate) touch: Vec<f64>,
}

/// A clock that was found, and its accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Found {
    pub(crate) clock: Clock,
    /// Median deviation of single presses from it, s.
    pub(crate) residual_s: f64,
}

/// Largest relative difference between the rates of two clocks.
const MOST_DRIFT: f64 = 0.01;
/// Number of bins of the first search.
const BINS: usize = 1500;
/// Any other offset must have a score below this fraction of the best one.
const CLEARLY: f64 = 0.93;
/// Number of bins within the peak of the best offset that may be lower.
const PEAK_GAP: i64 = 4;
/// Smallest correlation that counts as a match.
const MATCHES: f64 = 0.6;

/// Finds the clock of `other` on the clock of `main`.
///
/// A first search finds offset and rate to within a bin. Then each stretch of time with contact
/// gives the offset there, and a line through these offsets (Theil-Sen) gives the clock.
///
/// # Errors
/// A text for people: the two have nothing in common, or more than one offset fits.
pub(crate) fn find(main: &Activity, other: &Activity) -> Result<Found, String> {
    let span_s = |activity: &Activity| match (activity.time_s.first(), activity.time_s.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    };
    let longest_s = span_s(main).max(span_s(other));
    if span_s(main) <= 0.0 || span_s(other) <= 0.0 {
        return Err("the times of one of the two do not increase".to_owned());
    }
    let bin_s = longest_s / BINS as f64;
    let mut clock = look(main, other, bin_s)?;
    let finest_s = median_step_s(main).max(median_step_s(other)).min(bin_s) / 4.0;
    let mut residual_s = f64::NAN;
    for within_s in [2.5 * bin_s, 0.6 * bin_s.max(8.0 * finest_s), 8.0 * finest_s] {
        let lags = lags(main, other, clock, within_s.min(2.0), finest_s);
        let Some((at_zero_s, slope, spread_s)) = line_through(&lags) else {
            return Err("too few presses match in the two".to_owned());
        };
        clock = Clock {
            offset_s: (1.0 - slope) * clock.offset_s - at_zero_s,
            rate: (1.0 - slope) * clock.rate,
        };
        residual_s = spread_s;
    }
    Ok(Found { clock, residual_s })
}

/// The offset and rate with the highest score, to within a bin.
fn look(main: &Activity, other: &Activity, bin_s: f64) -> Result<Clock, String> {
    let main_from_s = main.time_s[0];
    let main_bins = binned(main, bin_s, 1.0);
    let mut best: Option<(f64, Clock)> = None;
    let mut scores: Vec<(f64, f64)> = Vec::new();
    let n_rates = (MOST_DRIFT * BINS as f64).ceil() as i32;
    for step in -n_rates..=n_rates {
        let rate = 1.0 + MOST_DRIFT * f64::from(step) / f64::from(n_rates);
        let other_bins = binned(other, bin_s, rate);
        for shift in 1 - other_bins.len() as i64..main_bins.len() as i64 {
            let score = likeness(&main_bins, &other_bins, shift);
            let offset_s = main_from_s + shift as f64 * bin_s - rate * other.time_s[0];
            if score >= MATCHES {
                // The offset is identified by where the middle of the other file lies, for all
                // rates.
                let middle_s =
                    offset_s + rate * 0.5 * (other.time_s[0] + other.time_s[other.time_s.len() - 1]);
                scores.push((middle_s, score));
            }
            if best.is_none_or(|(most, _)| score > most) {
                best = Some((score, Clock { offset_s, rate }));
            }
        }
    }
    let Some((most, clock)) = best.filter(|(most, _)| *most >= MATCHES) else {
        return Err("nothing matches in the two; are there presses in both?".to_owned());
    };
    let middle_s = clock.convert(0.5 * (other.time_s[0] + other.time_s[other.time_s.len() - 1]));
    match rival(&scores, middle_s, CLEARLY * most, bin_s) {
        Some(later_s) => Err(format!(
            "an offset that is {later_s:.2} s larger fits as well: the presses are all alike; give the clock"
        )),
        None => Ok(clock),
    }
}

/// Distance from `best_s` to another offset with a score above `high`, apart from the offsets in
/// the best one's peak, s. `scores` are pairs of offset, s, and score.
fn rival(scores: &[(f64, f64)], best_s: f64, high: f64, bin_s: f64) -> Option<f64> {
    let bin = |(at_s, _): &(f64, f64)| ((at_s - best_s) / bin_s).round() as i64;
    let as_high = scores.iter().filter(|(_, score)| *score > high);
    let bins: BTreeSet<i64> = as_high.map(bin).collect();
    // The peak of the best offset: all bins above `high` without a large gap.
    let goes_on = |edge: i64, step: i64| {
        (1..=PEAK_GAP)
            .map(|gap| edge + step * gap)
            .find(|bin| bins.contains(bin))
    };
    let edge = |step: i64| std::iter::successors(Some(0), |edge| goes_on(*edge, step)).last();
    let (first, last) = (edge(-1)?, edge(1)?);
    let apart = bins.into_iter().find(|bin| !(first..=last).contains(bin))?;
    Some(apart as f64 * bin_s)
}

/// Means over bins of time, from the first time on, at a rate.
fn binned(activity: &Activity, bin_s: f64, rate: f64) -> Vec<f64> {
    let from_s = activity.time_s[0];
    let n = (rate * (activity.time_s[activity.time_s.len() - 1] - from_s) / bin_s) as usize + 1;
    let (mut sums, mut counts) = (vec![0.0; n], vec![0_u32; n]);
    for (time_s, touch) in activity.time_s.iter().zip(&activity.touch) {
        let bin = ((rate * (time_s - from_s) / bin_s) as usize).min(n - 1);
        sums[bin] += touch;
        counts[bin] += 1;
    }
    let mut last = 0.0;
    for (sum, count) in sums.iter_mut().zip(counts) {
        *sum = if count > 0 { *sum / f64::from(count) } else { last };
        last = *sum;
    }
    sums
}

/// Score of a shift by a number of bins, at most 1: the correlation in the overlap, reduced by
/// contact of both outside of it.
fn likeness(main: &[f64], other: &[f64], shift: i64) -> f64 {
    let from = shift.max(0) as usize;
    let to = (main.len() as i64).min(shift + other.len() as i64) as usize;
    if to <= from {
        return 0.0;
    }
    let skipped = (from as i64 - shift) as usize;
    let both = main[from..to].iter().zip(&other[skipped..]);
    let [
        mut one_sum,
        mut two_sum,
        mut one_power,
        mut two_power,
        mut product,
    ] = [0.0; 5];
    for (one, two) in both {
        one_sum += one;
        two_sum += two;
        one_power += one * one;
        two_power += two * two;
        product += one * two;
    }
    let power = |signal: &[f64]| signal.iter().map(|value| value * value).sum::<f64>();
    // A file that was started later or ended earlier lacks some presses. Only those of the shorter
    // file must be there.
    let kept =
        (one_power / power(main).max(f64::MIN_POSITIVE)).max(two_power / power(other).max(f64::MIN_POSITIVE));
    // Relative to the means: otherwise presses that follow each other closely would correlate at
    // any shift.
    let n = (to - from) as f64;
    let variances = (one_power - one_sum * one_sum / n) * (two_power - two_sum * two_sum / n);
    let covariance = product - one_sum * two_sum / n;
    kept * covariance / variances.max(f64::MIN_POSITIVE).sqrt()
}

/// The delay of the other file's contact relative to the main file's, in stretches of time: time,
/// s, and delay, s.
fn lags(main: &Activity, other: &Activity, clock: Clock, within_s: f64, finest_s: f64) -> Vec<(f64, f64)> {
    let mapped: Vec<f64> = other.time_s.iter().map(|time_s| clock.convert(*time_s)).collect();
    let from_s = main.time_s[0].max(mapped[0]);
    let to_s = main.time_s[main.time_s.len() - 1].min(mapped[mapped.len() - 1]);
    let stretch_s = ((to_s - from_s) / 60.0).max(3.0).max(3.0 * within_s);
    let most = main.touch.iter().copied().fold(0.0, f64::max);
    let mut lags = Vec::new();
    let mut begin_s = from_s + within_s;
    while begin_s + stretch_s <= to_s - within_s {
        let n = (stretch_s / finest_s) as usize;
        let times = (0..n).map(|index| begin_s + index as f64 * finest_s);
        let here: Vec<f64> = Resampled::new(&main.time_s, &main.touch).over(times).collect();
        let peak = here.iter().copied().fold(0.0, f64::max);
        if peak > 0.15 * most {
            let n_lags = (within_s / finest_s) as i64;
            let there = (-n_lags..n as i64 + n_lags).map(|index| begin_s + index as f64 * finest_s);
            let there: Vec<f64> = Resampled::new(&mapped, &other.touch).over(there).collect();
            if let Some(lag) = best_lag(&here, &there, n_lags) {
                lags.push((begin_s + 0.5 * stretch_s, lag * finest_s));
            }
        }
        begin_s += 0.5 * stretch_s;
    }
    lags
}

/// The lag, in steps, with the highest correlation. `there` extends `n_lags` steps further on both
/// sides. `None` if the best lag is at an end.
fn best_lag(here: &[f64], there: &[f64], n_lags: i64) -> Option<f64> {
    let mean = |signal: &[f64]| signal.iter().sum::<f64>() / signal.len() as f64;
    let here_mean = mean(here);
    let score = |lag: i64| {
        let start = (lag + n_lags) as usize;
        let part = &there[start..start + here.len()];
        let part_mean = mean(part);
        let (mut product, mut power, mut other) = (0.0, 0.0, 0.0);
        for (one, two) in here.iter().zip(part) {
            let (one, two) = (one - here_mean, two - part_mean);
            product += one * two;
            power += one * one;
            other += two * two;
        }
        product / (power * other).sqrt().max(f64::MIN_POSITIVE)
    };
    let scores: Vec<f64> = (-n_lags..=n_lags).map(score).collect();
    let best = (0..scores.len()).max_by(|one, two| scores[*one].total_cmp(&scores[*two]))?;
    if best == 0 || best + 1 == scores.len() || scores[best] < MATCHES {
        return None;
    }
    // The vertex of the parabola through the three best scores.
    let [before, top, after] = [scores[best - 1], scores[best], scores[best + 1]];
    let bend = before - 2.0 * top + after;
    let aside = if bend < 0.0 {
        0.5 * (before - after) / bend
    } else {
        0.0
    };
    Some(best as f64 - n_lags as f64 + aside)
}

/// A robust line through points: its value at 0, its slope, and the median deviation of the points.
fn line_through(points: &[(f64, f64)]) -> Option<(f64, f64, f64)> {
    if points.len() < 2 {
        return points.first().map(|(_, lag)| (*lag, 0.0, 0.0));
    }
    let mut slopes = Vec::new();
    for (index, (one_s, one)) in points.iter().enumerate() {
        let later = points[index + 1..].iter().filter(|(other_s, _)| other_s > one_s);
        slopes.extend(later.map(|(other_s, other)| (other - one) / (other_s - one_s)));
    }
    let slope = median(slopes)?;
    let zeros: Vec<f64> = points.iter().map(|(at_s, lag)| lag - slope * at_s).collect();
    let zero = median(zeros)?;
    let off: Vec<f64> = points
        .iter()
        .map(|(at_s, lag)| (lag - slope * at_s - zero).abs())
        .collect();
    Some((zero, slope, median(off)?))
}

fn median_step_s(activity: &Activity) -> f64 {
    let steps = activity.time_s.windows(2).map(|pair| pair[1] - pair[0]);
    median(steps.collect()).unwrap_or(0.01).max(1e-4)
}

/// A signal with linear interpolation, evaluated at increasing times.
struct Resampled<'a> {
    time_s: &'a [f64],
    values: &'a [f64],
    at: usize,
}

impl<'a> Resampled<'a> {
    fn new(time_s: &'a [f64], values: &'a [f64]) -> Self {
        Self {
            time_s,
            values,
            at: 0,
        }
    }

    fn over(mut self, times: impl Iterator<Item = f64>) -> impl Iterator<Item = f64> {
        self.at = 0;
        let mut is_first = true;
        times.map(move |time_s| {
            if std::mem::take(&mut is_first) {
                self.at = self
                    .time_s
                    .partition_point(|before_s| *before_s <= time_s)
                    .saturating_sub(1);
            }
            while self.at + 1 < self.time_s.len() && self.time_s[self.at + 1] <= time_s {
                self.at += 1;
            }
            let (this, next) = (self.at, (self.at + 1).min(self.time_s.len() - 1));
            let step_s = self.time_s[next] - self.time_s[this];
            let part = if step_s > 0.0 {
                ((time_s - self.time_s[this]) / step_s).clamp(0.0, 1.0)
            } else {
                0.0
            };
            self.values[this] + part * (self.values[next] - self.values[this])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Strength of contact at a time, s, for presses of different depths.
    fn touch(time_s: f64) -> f64 {
        let press = (time_s / 4.0).floor();
        let within_s = time_s - 4.0 * press - 0.5 - 0.3 * (press * 1.7).sin();
        let depth = 1.0 + 0.6 * (press * 2.3).sin();
        if press < 0.0 || !(0.0..2.5).contains(&within_s) {
            return 0.0;
        }
        depth * (std::f64::consts::PI * within_s / 2.5).sin().max(0.0).powf(1.5)
    }

    fn seen(from_s: f64, to_s: f64, rate_hz: f64, clock: Clock, gain: f64) -> Activity {
        let n = ((to_s - from_s) * rate_hz) as usize;
        let true_s: Vec<f64> = (0..n).map(|index| from_s + index as f64 / rate_hz).collect();
        Activity {
            // The file's own times; the clock converts them to true times.
            time_s: true_s
                .iter()
                .map(|time_s| (time_s - clock.offset_s) / clock.rate)
                .collect(),
            touch: true_s.iter().map(|time_s| gain * touch(*time_s)).collect(),
        }
    }

    const SAME: Clock = Clock {
        offset_s: 0.0,
        rate: 1.0,
    };

    #[test]
    fn clocks_that_are_apart_and_run_at_other_rates_are_found() {
        for (offset_s, rate) in [
            (1.12, 1.003),
            (-37.5, 0.997),
            (0.0, 1.0),
            (1.7e9, 1.0005),
            (250.0, 0.9925),
        ] {
            let clock = Clock { offset_s, rate };
            let main = seen(0.0, 300.0, 55.0, SAME, 20.0);
            let other = seen(-5.0, 280.0, 180.0, clock, 3.0);
            let found = find(&main, &other).unwrap();
            let worst_s = other
                .time_s
                .iter()
                .map(|time_s| (found.clock.convert(*time_s) - clock.convert(*time_s)).abs());
            let worst_s = worst_s.fold(0.0, f64::max);
            assert!(worst_s < 0.005, "{offset_s} {rate}: {worst_s} s, {found:?}");
        }
    }

    #[test]
    fn what_is_not_alike_is_not_joined_and_presses_that_are_all_alike_are_ambiguous() {
        let main = seen(0.0, 120.0, 50.0, SAME, 1.0);
        let silent = Activity {
            time_s: main.time_s.clone(),
            touch: vec![0.0; main.time_s.len()],
        };
        assert!(find(&main, &silent).unwrap_err().contains("nothing matches"));
        let alike = |from_s: f64| Activity {
            time_s: (0..6000).map(|index| 0.02 * f64::from(index)).collect(),
            touch: (0..6000)
                .map(|index| touch((from_s + 0.02 * f64::from(index)) % 4.0))
                .collect(),
        };
        let error = find(&alike(0.0), &alike(1.0)).unwrap_err();
        assert!(error.contains("fits as well"), "{error}");
    }
}
