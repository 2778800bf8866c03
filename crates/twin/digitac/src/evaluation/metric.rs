//! Errors of predictions, in % of the largest reading.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::PairedPress;

/// The definition that is stored with every score.
pub(crate) const DEFINITION: &str = "Errors are mean absolute differences between predicted and measured readings over the largest \
    reading of the same file, in percent. 'Nearest, in contact' (the headline) takes, of the frames with depth > 0 whose largest \
    reading exceeds 3 % of the file's largest, the taxel with the largest reading. 'All' takes every taxel in every frame. 'Peak' \
    compares, press by press, the largest reading of the press with the largest prediction of the same taxel. Taxels left out count in \
    neither; frames nearest to one are left out of the headline. Readings are compared on the recording's own clock, and every usable one counts.";

/// Frames whose largest reading is below this fraction of the file's largest do not count as
/// contact.
const CONTACT_FRACTION: f64 = 0.03;

/// Largest reading of each file, kPa, from all its presses, scored or not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scale {
    /// Taxels that are excluded from the headline, by index.
    pub left_out: BTreeSet<usize>,
    /// Largest reading of each file, kPa.
    pub largest_kpa: BTreeMap<String, f64>,
}

impl Scale {
    /// Finds the largest readings in the presses of whole files.
    #[must_use]
    pub fn of<'a>(presses: impl IntoIterator<Item = &'a PairedPress>, left_out: BTreeSet<usize>) -> Self {
        let mut largest_kpa: BTreeMap<String, f64> = BTreeMap::new();
        for press in presses {
            let largest = largest_kpa.entry(press.mounting.clone()).or_insert(0.0);
            for frame in 0..press.readings_kpa.len() {
                if let Some((taxel, reading)) = nearest(press, frame)
                    && !left_out.contains(&taxel)
                {
                    *largest = largest.max(reading);
                }
            }
        }
        Self {
            left_out,
            largest_kpa,
        }
    }
}

/// A mean, %, and the number of its values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mean {
    /// The mean, %; `None` if nothing was counted.
    pub percent: Option<f64>,
    /// Number of values.
    pub count: usize,
}

/// Errors of some presses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Mean absolute error of the nearest taxel, in frames in contact: the headline.
    pub nearest_in_contact: Mean,
    /// Mean absolute error of all taxels, in all frames.
    pub all: Mean,
    /// Mean absolute error of the largest reading of each press.
    pub peak: Mean,
}

/// Errors of presses, in total and by file and taxel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Definition of the figures.
    pub definition: String,
    /// All presses.
    pub overall: Errors,
    /// Errors by file.
    pub by_file: BTreeMap<String, Errors>,
    /// Errors by taxel, excluded or not; `[n_taxels]`. A taxel's headline uses the frames in which
    /// it is the nearest.
    pub by_taxel: Vec<Errors>,
    /// Number of frames deeper than the simulation. They are scored all the same, with the last
    /// simulated pressures.
    pub n_frames_not_simulated: usize,
    /// Number of all frames.
    #[serde(default)]
    pub n_frames: usize,
}

/// Scores predictions, `[n_presses][n_frames][n_taxels]`, kPa.
#[must_use]
pub(crate) fn score<'a>(
    presses: impl IntoIterator<Item = &'a PairedPress>,
    predictions: &[Vec<Vec<f64>>],
    scale: &Scale,
) -> Score {
    let mut overall = Sums::default();
    let mut by_file: BTreeMap<String, Sums> = BTreeMap::new();
    let mut by_taxel: Vec<Sums> = Vec::new();
    let (mut n_frames_not_simulated, mut n_frames) = (0, 0);
    for (press, prediction) in presses.into_iter().zip(predictions) {
        let largest_kpa = scale.largest_kpa.get(&press.mounting).copied().unwrap_or(0.0);
        if largest_kpa <= 0.0 {
            continue;
        }
        let file = by_file.entry(press.mounting.clone()).or_default();
        by_taxel.resize_with(
            by_taxel.len().max(press.readings_kpa.first().map_or(0, Vec::len)),
            Sums::default,
        );
        n_frames += press.readings_kpa.len();
        n_frames_not_simulated += press
            .features
            .simulated
            .iter()
            .filter(|simulated| !**simulated)
            .count();
        let error = |frame: usize, taxel: usize| {
            100.0 * (prediction[frame][taxel] - press.readings_kpa[frame][taxel]).abs() / largest_kpa
        };
        let mut peak: Option<(usize, f64)> = None;
        for frame in 0..press.readings_kpa.len() {
            for (taxel, valid) in press.valid[frame].iter().enumerate() {
                if *valid {
                    let error = error(frame, taxel);
                    by_taxel[taxel].all.add(error);
                    if !scale.left_out.contains(&taxel) {
                        overall.all.add(error);
                        file.all.add(error);
                    }
                }
            }
            let Some((taxel, reading)) = nearest(press, frame) else {
                continue;
            };
            if press.features.depth_mm[frame] > 0.0 && reading > CONTACT_FRACTION * largest_kpa {
                let error = error(frame, taxel);
                by_taxel[taxel].nearest.add(error);
                if !scale.left_out.contains(&taxel) {
                    overall.nearest.add(error);
                    file.nearest.add(error);
                    if peak.is_none_or(|(_, highest)| reading > highest) {
                        peak = Some((taxel, reading));
                    }
                }
            }
        }
        if let Some((taxel, reading)) = peak {
            let frames = prediction
                .iter()
                .zip(&press.valid)
                .filter(|(_, valid)| valid[taxel]);
            let predicted = frames
                .map(|(row, _)| row[taxel])
                .fold(f64::NEG_INFINITY, f64::max);
            let error = 100.0 * (predicted - reading).abs() / largest_kpa;
            overall.peak.add(error);
            file.peak.add(error);
            by_taxel[taxel].peak.add(error);
        }
    }
    Score {
        definition: DEFINITION.to_owned(),
        overall: overall.errors(),
        by_file: by_file
            .into_iter()
            .map(|(file, sums)| (file, sums.errors()))
            .collect(),
        by_taxel: by_taxel.iter().map(Sums::errors).collect(),
        n_frames_not_simulated,
        n_frames,
    }
}

/// The taxel with the largest usable reading of a frame, and the reading, kPa.
pub(crate) fn nearest(press: &PairedPress, frame: usize) -> Option<(usize, f64)> {
    let row = press.readings_kpa[frame]
        .iter()
        .zip(&press.valid[frame])
        .enumerate();
    row.filter(|(_, (_, valid))| **valid)
        .map(|(taxel, (reading, _))| (taxel, *reading))
        .max_by(|a, b| a.1.total_cmp(&b.1))
}

#[derive(Clone, Debug, Default)]
struct Sum {
    total: f64,
    count: usize,
}

impl Sum {
    fn add(&mut self, value: f64) {
        self.total += value;
        self.count += 1;
    }

    fn mean(&self) -> Mean {
        Mean {
            percent: (self.count > 0).then(|| self.total / self.count as f64),
            count: self.count,
        }
    }
}

#[derive(Clone, Debug, Default)]
struct Sums {
    nearest: Sum,
    all: Sum,
    peak: Sum,
}

impl Sums {
    fn errors(&self) -> Errors {
        Errors {
            nearest_in_contact: self.nearest.mean(),
            all: self.all.mean(),
            peak: self.peak.mean(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::by_hand;

    fn near(mean: Mean, percent: f64, count: usize) -> bool {
        mean.percent.is_some_and(|found| (found - percent).abs() < 1e-9) && mean.count == count
    }

    #[test]
    fn the_headline_takes_the_nearest_taxel_in_contact_only() {
        // Above the gel; touching, but below 3 %; and twice in contact, where each of the two
        // taxels is once the nearest.
        let frames = [
            (-1.0, [9.0, 0.0]),
            (0.1, [2.9, 0.0]),
            (1.0, [50.0, 20.0]),
            (2.0, [30.0, 100.0]),
        ];
        let press = by_hand("a", "file", [0.0, 0.0], &frames);
        let scale = Scale::of([&press], BTreeSet::new());
        assert_eq!(scale.largest_kpa["file"], 100.0);
        let prediction = vec![vec![9.0, 8.0], vec![2.9, 0.0], vec![53.0, 20.0], vec![30.0, 95.0]];
        let score = score([&press], &[prediction], &scale);
        assert!(near(score.overall.nearest_in_contact, 4.0, 2), "{score:?}");
        assert!(near(score.overall.all, 2.0, 8), "{score:?}");
        assert!(near(score.overall.peak, 5.0, 1), "{score:?}");
        assert!(near(score.by_taxel[0].nearest_in_contact, 3.0, 1), "{score:?}");
        assert!(near(score.by_taxel[1].all, 13.0 / 4.0, 4), "{score:?}");
    }

    #[test]
    fn unusable_readings_and_taxels_left_out_do_not_count() {
        let mut press = by_hand(
            "a",
            "file",
            [0.0, 0.0],
            &[(1.0, [80.0, 10.0]), (1.0, [10.0, 40.0]), (1.0, [0.0, 900.0])],
        );
        press.valid[2][1] = false;
        let scale = Scale::of([&press], BTreeSet::from([0]));
        assert_eq!(scale.largest_kpa["file"], 40.0);
        let score = score(
            [&press],
            &[vec![vec![0.0, 10.0], vec![10.0, 38.0], vec![0.0, 0.0]]],
            &scale,
        );
        assert!(near(score.overall.nearest_in_contact, 5.0, 1), "{score:?}");
        assert!(near(score.overall.all, 2.5, 2), "{score:?}");
        assert!(near(score.by_taxel[0].nearest_in_contact, 200.0, 1), "{score:?}");
    }

    #[test]
    fn a_score_over_no_frames_is_none() {
        let press = by_hand("a", "file", [0.0, 0.0], &[(1.0, [0.0, -1.0])]);
        let scale = Scale::of([&press], BTreeSet::new());
        let score = score([&press], &[vec![vec![1.0, 1.0]]], &scale);
        assert_eq!(score.overall, Errors::default());
        assert_eq!(score.overall.all.percent, None);
        // A press that never touches the gel has readings, but no frame in contact.
        let press = by_hand("a", "file", [0.0, 0.0], &[(-1.0, [5.0, 1.0]), (-2.0, [2.0, 1.0])]);
        let scale = Scale::of([&press], BTreeSet::new());
        let found = super::score([&press], &[vec![vec![5.0, 1.0]; 2]], &scale).overall;
        assert_eq!(found.nearest_in_contact, Mean::default());
        assert_eq!(found.peak.percent, None);
        assert_eq!(found.all.count, 4);
        assert_eq!(
            serde_json::to_value(found.peak).unwrap(),
            serde_json::json!({"percent": null, "count": 0})
        );
    }
}
