//! Noise of the readings while nothing touches the gel.

use serde::Serialize;

use crate::rest::Rest;
use crate::statistics::{deviation, mean};
use crate::untouched::Untouched;
use crate::{CharacterizeOptions, Finding};

/// Smallest number of unloaded frames for a press to count.
const FEWEST_FRAMES: usize = 8;

/// The noise of a taxel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Noise {
    /// The taxel's name.
    pub taxel: String,
    /// Noise floor, kPa: standard deviation of unloaded readings about the mean of their press,
    /// pooled over all presses. Without presses: about the mean of their window of five seconds.
    pub deviation_kpa: f64,
    /// Standard deviation of the change of the mean between neighbouring averaging windows without
    /// a load, kPa. It contains the noise that averaging leaves, and drift.
    pub window_deviation_kpa: Option<f64>,
    /// Number of pairs of windows it was found from.
    pub n_windows: usize,
    /// Number of unloaded readings.
    pub n_readings: usize,
}

/// From the frames before contact in presses. For logs without presses: from windows in which
/// nothing touches.
pub(crate) fn noise(
    rests: &[Rest<'_>],
    untouched: &[Untouched],
    taxels: &[String],
    options: &CharacterizeOptions,
) -> Finding<Vec<Noise>> {
    let found = taxels.iter().enumerate().filter_map(|(taxel, name)| {
        let (mut squares, mut freedom, mut n_readings) = (0.0, 0, 0);
        let mut changes_kpa = Vec::new();
        for press in rests {
            let rest = press.readings_kpa(taxel, &press.before);
            if let Some(deviation_kpa) = deviation(&rest).filter(|_| rest.len() >= FEWEST_FRAMES) {
                squares += deviation_kpa.powi(2) * (rest.len() - 1) as f64;
                freedom += rest.len() - 1;
                n_readings += rest.len();
            }
            changes_kpa.extend(window_changes_kpa(press, taxel, options.window_s));
        }
        if rests.is_empty() {
            for window in untouched
                .iter()
                .skip(taxel)
                .take(1)
                .flat_map(|of_taxel| &of_taxel.windows)
            {
                squares += window.deviation_kpa.powi(2) * (window.n_readings - 1) as f64;
                freedom += window.n_readings - 1;
                n_readings += window.n_readings;
            }
        }
        (freedom > 0).then(|| Noise {
            taxel: name.clone(),
            deviation_kpa: (squares / freedom as f64).sqrt(),
            window_deviation_kpa: (changes_kpa.len() >= FEWEST_FRAMES)
                .then(|| root_mean_square(&changes_kpa)),
            n_windows: changes_kpa.len(),
            n_readings,
        })
    });
    Finding::of_list(
        found.collect(),
        "no press begins with eight or more unloaded frames, and no log without presses has enough",
    )
}

/// Changes of the mean between neighbouring windows before contact. Their expected value is zero.
fn window_changes_kpa(press: &Rest<'_>, taxel: usize, window_s: f64) -> Vec<f64> {
    let rest = press.before.clone();
    let times_s = &press.press.time_s[rest.clone()];
    let Some(first_s) = times_s.first() else {
        return Vec::new();
    };
    let end_s = times_s[times_s.len() - 1];
    let n_windows = ((end_s - first_s) / window_s + 1e-9) as usize;
    let means: Option<Vec<f64>> = (0..n_windows)
        .map(|window| {
            let edge = |number: usize| {
                let at_s = first_s + number as f64 * window_s;
                rest.start + times_s.partition_point(|time_s| *time_s < at_s)
            };
            mean(&press.readings_kpa(taxel, &(edge(window)..edge(window + 1))))
        })
        .collect();
    let means = means.unwrap_or_default();
    // Pairs that share no window are independent, except for drift.
    means.chunks_exact(2).map(|pair| pair[1] - pair[0]).collect()
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, press, rests, untouched};

    #[test]
    fn known_noise_is_found() {
        let shape = Shape {
            noise_kpa: 0.02,
            rest_s: 10.0,
            ..Shape::default()
        };
        let presses = [press(&shape), press(&shape)];
        let names = ["a".to_owned(), "b".to_owned()];
        let finding = noise(&rests(&presses), &[], &names, &CharacterizeOptions::default());
        let found = finding.found().unwrap();
        assert_eq!(found.len(), 2);
        assert!((found[0].deviation_kpa / 0.02 - 1.0).abs() < 0.02, "{found:?}");
        assert_eq!(found[0].n_readings, 2 * 250);
    }

    #[test]
    fn a_log_without_presses_tells_it_too() {
        let names = ["a".to_owned(), "b".to_owned()];
        let reads_kpa = |at_s: f64| {
            [
                100.0 + 0.02 * super::super::synthetic::noise(0.3, (50.0 * at_s) as usize),
                99.0,
            ]
        };
        let log = untouched(60.0, reads_kpa, |_| f64::NAN);
        let windows = Untouched::all(&[log], 2);
        let finding = noise(&[], &windows, &names, &CharacterizeOptions::default());
        let found = finding.found().unwrap();
        assert!((found[0].deviation_kpa / 0.02 - 1.0).abs() < 0.02, "{found:?}");
        assert_eq!((found[0].n_readings, found[0].n_windows), (3000, 0));
    }

    #[test]
    fn no_rest_is_said() {
        let shape = Shape {
            rest_s: 0.1,
            ..Shape::default()
        };
        let presses = [press(&shape)];
        let finding = noise(
            &rests(&presses),
            &[],
            &["a".to_owned(), "b".to_owned()],
            &CharacterizeOptions::default(),
        );
        assert!(finding.why_not().unwrap().contains("unloaded"));
    }
}
