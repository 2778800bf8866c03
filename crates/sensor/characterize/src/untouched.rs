//! Readings outside of presses while nothing touches the sensor, averaged over windows of time.
//!
//! A window in which a taxel's readings jump is left out for this taxel: something touched the
//! sensor, or its signal was disturbed.

use twintac_recording::Frames;

use crate::statistics::{deviation, mean, median};

/// Length of a window, s: long enough for tens of frames, short compared with changes of
/// temperature.
const WINDOW_S: f64 = 5.0;

/// Smallest number of readings in a window.
const FEWEST: usize = 3;

/// A window jumps if its standard deviation exceeds the median one by this factor.
const LEAP: f64 = 5.0;

/// The windows of one taxel.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Untouched {
    /// The windows in order, log by log.
    pub(crate) windows: Vec<Window>,
    /// Number of windows that were left out because readings jump in them.
    pub(crate) n_leaps: usize,
}

/// A taxel's readings in one window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Window {
    /// Index of its log.
    pub(crate) log: usize,
    /// Middle of the window, s of the log's clock.
    pub(crate) time_s: f64,
    /// Mean reading, kPa.
    pub(crate) mean_kpa: f64,
    /// Standard deviation of single readings, kPa.
    pub(crate) deviation_kpa: f64,
    /// Mean temperature, °C, if it was measured.
    pub(crate) temperature_c: Option<f64>,
    pub(crate) n_readings: usize,
}

impl Untouched {
    /// The windows of each taxel of these logs.
    pub(crate) fn all(logs: &[Frames], n_taxels: usize) -> Vec<Self> {
        (0..n_taxels).map(|taxel| Self::of(logs, taxel)).collect()
    }

    fn of(logs: &[Frames], taxel: usize) -> Self {
        let windows = logs.iter().enumerate().flat_map(|(log, frames)| {
            let starts = starts(&frames.time_s);
            let ends = starts.iter().skip(1).copied().chain([frames.time_s.len()]);
            let ranges: Vec<_> = starts.iter().copied().zip(ends).collect();
            ranges.into_iter().filter_map(move |(start, end)| {
                let of = |rows: &[Vec<f64>]| -> Vec<f64> {
                    let numbers = rows[start..end].iter().map(|row| row[taxel]);
                    numbers.filter(|number| !number.is_nan()).collect()
                };
                let readings_kpa = of(&frames.readings_kpa);
                let deviation_kpa = deviation(&readings_kpa).filter(|_| readings_kpa.len() >= FEWEST)?;
                Some(Window {
                    log,
                    time_s: 0.5 * (frames.time_s[start] + frames.time_s[end - 1]),
                    mean_kpa: mean(&readings_kpa)?,
                    deviation_kpa,
                    temperature_c: mean(&of(&frames.temperature_c)),
                    n_readings: readings_kpa.len(),
                })
            })
        });
        let all: Vec<Window> = windows.collect();
        let deviations: Vec<f64> = all.iter().map(|window| window.deviation_kpa).collect();
        let usual_kpa = median(&deviations).unwrap_or(0.0);
        let n_all = all.len();
        // If most windows are constant, because readings are quantized, the median is zero and no
        // window is left out.
        let limit_kpa = if usual_kpa > 0.0 {
            LEAP * usual_kpa
        } else {
            f64::INFINITY
        };
        let rests = all.into_iter().filter(|window| window.deviation_kpa <= limit_kpa);
        let windows: Vec<Window> = rests.collect();
        Self {
            n_leaps: n_all - windows.len(),
            windows,
        }
    }
}

/// Index of the first frame of each window.
fn starts(time_s: &[f64]) -> Vec<usize> {
    let mut starts = Vec::new();
    let mut begun_s = f64::NEG_INFINITY;
    for (frame, at_s) in time_s.iter().enumerate() {
        if *at_s >= begun_s + WINDOW_S {
            starts.push(frame);
            begun_s = *at_s;
        }
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{noise, untouched};

    #[test]
    fn windows_are_five_seconds_long_and_one_that_is_touched_is_left_out() {
        let mut frames = untouched(
            60.0,
            |at_s| [100.0 + 0.01 * noise(0.0, (50.0 * at_s) as usize), 101.0],
            |_| 25.0,
        );
        let found = Untouched::all(std::slice::from_ref(&frames), 2);
        assert_eq!((found[0].windows.len(), found[0].n_leaps), (12, 0));
        assert!(
            (found[0].windows[3].time_s - 17.5).abs() < 0.02,
            "{:?}",
            found[0].windows[3]
        );
        assert!((found[0].windows[3].deviation_kpa - 0.01).abs() < 1e-3);
        assert_eq!(found[0].windows[3].temperature_c, Some(25.0));
        for row in &mut frames.readings_kpa[1100..1120] {
            row[0] += 3.0;
        }
        let found = Untouched::all(&[frames], 2);
        assert_eq!((found[0].windows.len(), found[0].n_leaps), (11, 1));
        assert_eq!((found[1].windows.len(), found[1].n_leaps), (12, 0));
    }

    #[test]
    fn readings_that_are_missing_make_no_window() {
        let frames = untouched(
            20.0,
            |at_s| [if at_s < 10.0 { f64::NAN } else { 100.0 }, 101.0],
            |_| f64::NAN,
        );
        let found = Untouched::all(&[frames.clone(), frames], 2);
        assert_eq!(found[0].windows.len(), 4);
        assert_eq!(found[0].windows[3].log, 1);
        assert_eq!(found[0].windows[0].temperature_c, None);
    }
}
