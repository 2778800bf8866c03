//! Fits the twin again without some of its training presses, and finds its errors on these.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

use rayon::prelude::*;
use twintac_depth_table::DepthTable;
use twintac_recording::Recording;

use super::certain::rates_kpa_per_s;
use super::spread::{Known, Spread};
use super::training_set::{TrainingSet, quantile};
use super::{Certainty, Contact};
use crate::bench_fit::{features, refine_bench};
use crate::evaluation::predict_some;
use crate::{
    BenchEstimate, BenchSettings, DigitacError, PairedPress, Places, Scale, Split, Taxels, TrainSettings,
    Variant, train,
};

/// Fraction of the readings that the intervals have to cover.
const LEVEL: f64 = 0.9;
/// Number of times that the twin is fitted again for the intervals.
const N_FOLDS: usize = 4;
/// With fewer inner presses than this, no intervals are made.
const FEWEST_PRESSES: usize = 8;
/// Fraction of the frames of left-out presses that is not flagged.
const NOT_FLAGGED: f64 = 0.99;
/// The deepest and the outermost presses that are left out are one in this many.
const UNLIKE_PART: usize = 5;
/// Limits of the widening of intervals for each unit of the OOD score.
const GROWTH: [f64; 2] = [0.25, 10.0];

/// Everything that a twin is made of, to make it again.
pub struct TrainingData<'a> {
    /// The recorded presses.
    pub recording: &'a Recording,
    /// The same presses paired with the simulated gel, for the fitted test setup.
    pub presses: &'a [PairedPress],
    /// Their locations.
    pub places: &'a Places,
    /// Tables of the locations; `[n_places]`.
    pub tables: &'a [DepthTable],
    /// Contacts at the locations; `[n_places]`.
    pub contacts: &'a [Contact],
    /// Estimate of the test setup.
    pub bench: &'a BenchEstimate,
    /// Settings of the setup calibration.
    pub bench_settings: &'a BenchSettings,
    /// Ports and excluded taxels from the sensor's description.
    pub taxels: &'a Taxels,
    /// Settings of the training.
    pub train: &'a TrainSettings,
    /// Seed of the training.
    pub seed: u64,
    /// Presses whose locations are in the same square of this side belong together, mm.
    pub block_mm: f64,
    /// Largest readings, and excluded taxels.
    pub scale: &'a Scale,
}

/// A frame of a press that was not used to train the twin that predicted it.
#[derive(Clone)]
struct Frame {
    ood_score: f64,
    depth_mm: f64,
    /// For each usable reading, what is known before the measurement, and the error, kPa.
    readings: Vec<(Known, f64)>,
}

/// Finds the intervals and the OOD score of a twin of a variant, for a division of presses. Setup
/// and twin are fitted again four times without a quarter of the training presses, and without the
/// deepest and the outermost fifth. `None` if there are too few training presses.
///
/// The twins that are fitted again have no perceptron on top of the physics: it corrects little,
/// and takes most of the time of a training.
///
/// # Errors
/// Those of the fits.
pub fn calibrate(
    data: &TrainingData<'_>,
    split: &Split,
    variant: Variant,
) -> Result<Option<Certainty>, DigitacError> {
    let variant = variant.without_perceptron();
    let training_presses: BTreeSet<usize> = split.train.iter().chain(&split.validation).copied().collect();
    let folds = data.folds(&training_presses);
    let n_presses: usize = folds.iter().map(BTreeSet::len).sum();
    if n_presses < FEWEST_PRESSES {
        return Ok(None);
    }
    let of_folds = folds.par_iter().map(|fold| data.without(fold, split, variant));
    let frames = of_folds.collect::<Result<Vec<_>, _>>()?.concat();
    let errors: Vec<(Known, f64)> = frames
        .iter()
        .flat_map(|frame| frame.readings.iter().copied())
        .collect();
    let spread = Spread::fit(&errors);
    let factor = |in_contact: bool| {
        let of_state = frames.iter().filter(|frame| (frame.depth_mm > 0.0) == in_contact);
        let mut ratios: Vec<f64> = of_state
            .flat_map(|frame| &frame.readings)
            .map(|(known, error)| error.abs() / spread.kpa(known))
            .collect();
        quantile(&mut ratios, LEVEL)
    };
    let (in_air, in_contact) = (factor(false), factor(true));
    let Some(either) = in_contact.or(in_air) else {
        return Ok(None);
    };
    let of_contact = frames.iter().filter(|frame| frame.depth_mm > 0.0);
    let mut scores: Vec<f64> = of_contact.map(|frame| frame.ood_score).collect();
    let training_presses: Vec<usize> = training_presses.into_iter().collect();
    let mut certainty = Certainty {
        level_percent: 100.0 * LEVEL,
        threshold: quantile(&mut scores, NOT_FLAGGED).unwrap_or(1.0).max(1.0),
        learned_from: [n_presses, errors.len()],
        training_set: TrainingSet::by(data.presses, data.places, data.contacts, &training_presses),
        spread,
        factors: [in_air.unwrap_or(either), either],
        growth: GROWTH[0],
    };
    let mut growths = Vec::new();
    for unlike in data.unlike(&training_presses)? {
        let frames = data.without(&unlike, split, variant)?;
        let unlike = frames
            .iter()
            .filter(|frame| frame.ood_score > certainty.threshold);
        growths.extend(unlike.flat_map(|frame| {
            let usual = certainty.factor(frame.depth_mm);
            let needed = frame.readings.iter();
            needed.map(move |(known, error)| {
                (error.abs() / (usual * spread.kpa(known)) - 1.0) / (frame.ood_score - 1.0)
            })
        }));
    }
    let growth = quantile(&mut growths, LEVEL).unwrap_or(1.0);
    certainty.growth = growth.clamp(GROWTH[0], GROWTH[1]);
    Ok(Some(certainty))
}

impl Certainty {
    /// The same for a twin that was then trained on more presses: the intervals stay those of the
    /// earlier twin, and these presses make up the training set.
    #[must_use]
    pub fn with_training_set(&self, data: &TrainingData<'_>, training_presses: &[usize]) -> Self {
        Self {
            training_set: TrainingSet::by(data.presses, data.places, data.contacts, training_presses),
            ..self.clone()
        }
    }
}

impl TrainingData<'_> {
    fn place_mm(&self, press: usize) -> [f64; 2] {
        self.contacts[self.places.of_press[press]].place_mm
    }

    /// Training presses divided by location, such that the locations of one division lie between
    /// others. The outermost presses of each indenter are in no division.
    fn folds(&self, training_presses: &BTreeSet<usize>) -> Vec<BTreeSet<usize>> {
        let mut limits: BTreeMap<&str, [[f64; 2]; 2]> = BTreeMap::new();
        for &press in training_presses {
            let at = self.place_mm(press);
            let of_indenter = limits.entry(&self.presses[press].indenter).or_insert([at; 2]);
            for axis in 0..2 {
                of_indenter[0][axis] = of_indenter[0][axis].min(at[axis]);
                of_indenter[1][axis] = of_indenter[1][axis].max(at[axis]);
            }
        }
        let mut groups: BTreeMap<(&str, i64, i64), Vec<usize>> = BTreeMap::new();
        for &press in training_presses {
            let (indenter, at) = (&self.presses[press].indenter[..], self.place_mm(press));
            let [low, high] = limits[indenter];
            let is_outer =
                |axis: usize| low[axis] < high[axis] && (at[axis] == low[axis] || at[axis] == high[axis]);
            if !(is_outer(0) || is_outer(1)) {
                let [x, y] = at.map(|mm| (mm / self.block_mm).round() as i64);
                groups.entry((indenter, y, x)).or_default().push(press);
            }
        }
        let mut folds = vec![BTreeSet::new(); N_FOLDS];
        for (number, group) in groups.into_values().enumerate() {
            folds[number % N_FOLDS].extend(group);
        }
        folds.retain(|fold| !fold.is_empty());
        folds
    }

    /// The deepest training presses, and the outermost ones at one end of the axis with the largest
    /// range of locations.
    fn unlike(&self, training_presses: &[usize]) -> Result<[BTreeSet<usize>; 2], DigitacError> {
        let n = training_presses.len().div_ceil(UNLIKE_PART);
        let most = |value: &dyn Fn(usize) -> f64| {
            let mut sorted = training_presses.to_vec();
            sorted.sort_by(|a, b| value(*b).total_cmp(&value(*a)));
            sorted.into_iter().take(n).collect()
        };
        let depth_mm = |press: usize| {
            let depths = self.presses[press].features.depth_mm.iter();
            depths.copied().fold(0.0, f64::max)
        };
        let range = |axis: usize| {
            let along = || training_presses.iter().map(|&press| self.place_mm(press)[axis]);
            along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
        };
        let axis = usize::from(range(1) > range(0));
        Ok([most(&depth_mm), most(&|press| self.place_mm(press)[axis])])
    }

    /// Frames of the presses `left`, predicted by a twin of all other training presses.
    fn without(
        &self,
        left: &BTreeSet<usize>,
        split: &Split,
        variant: Variant,
    ) -> Result<Vec<Frame>, DigitacError> {
        let stays = |presses: &[usize]| -> Vec<usize> {
            presses
                .iter()
                .copied()
                .filter(|press| !left.contains(press))
                .collect()
        };
        let (train_with, mut validation) = (stays(&split.train), stays(&split.validation));
        if train_with.is_empty() {
            return Ok(Vec::new());
        }
        let training_presses = [&train_with[..], &validation].concat();
        if validation.is_empty() {
            validation.clone_from(&train_with);
        }
        let left: Vec<usize> = left.iter().copied().collect();
        let presses = self.remade(&training_presses)?;
        let division = Split {
            train: train_with,
            validation,
            test: left.clone(),
        };
        let settings = TrainSettings {
            variants: Some(vec![variant]),
            ..self.train.clone()
        };
        let trained = train(
            &presses,
            &self.recording.taxels,
            &division,
            self.scale,
            &settings,
            self.seed,
            &mut |_| ControlFlow::Continue(()),
        )?;
        let Some(trained) = trained.first() else {
            return Ok(Vec::new());
        };
        let predicted = predict_some(&trained.twin, &presses, &left);
        let training_set = TrainingSet::by(&presses, self.places, self.contacts, &training_presses);
        let mut frames = Vec::new();
        for (&press, predicted) in left.iter().zip(&predicted) {
            let contact = &self.contacts[self.places.of_press[press]];
            frames.extend(self.frames(&presses[press], predicted, contact, &training_set));
        }
        Ok(frames)
    }

    /// The paired presses for a test setup that is fitted to some of them.
    fn remade(&self, training_presses: &[usize]) -> Result<Vec<PairedPress>, DigitacError> {
        let settings = BenchSettings {
            n_blocks: 0,
            ..self.bench_settings.clone()
        };
        let (recording, places, tables) = (self.recording, self.places, self.tables);
        let mut bench = refine_bench(
            recording,
            places,
            tables,
            training_presses,
            self.bench,
            &settings,
            self.taxels,
        )?;
        for (mounting, height) in &self.bench.contact_offset_mm {
            bench.contact_offset_mm.entry(mounting.clone()).or_insert(*height);
        }
        let features = features(recording, places, tables, &bench)?;
        let pairs = self.presses.iter().zip(features);
        Ok(pairs
            .map(|(press, features)| PairedPress {
                features,
                ..press.clone()
            })
            .collect())
    }

    fn frames(
        &self,
        press: &PairedPress,
        predicted_kpa: &[Vec<f64>],
        contact: &Contact,
        training_set: &TrainingSet,
    ) -> Vec<Frame> {
        let frame = |frame: usize| {
            let row = &predicted_kpa[frame];
            let rates = rates_kpa_per_s(&press.features.time_s, predicted_kpa, frame);
            let depth_mm = press.features.depth_mm[frame];
            let ood_score = training_set.ood_score(contact.place_mm, &contact.underside, depth_mm);
            let largest_kpa = row.iter().fold(0.0_f64, |most, kpa| most.max(kpa.abs()));
            let usable = |taxel: &usize| press.valid[frame][*taxel] && !self.scale.left_out.contains(taxel);
            let reading = |taxel: usize| {
                let known = Known {
                    reading_kpa: row[taxel],
                    rate_kpa_per_s: rates[taxel],
                    largest_kpa,
                    ood_score: ood_score.min(1.0),
                };
                (known, press.readings_kpa[frame][taxel] - row[taxel])
            };
            Frame {
                ood_score,
                depth_mm,
                readings: (0..row.len()).filter(usable).map(reading).collect(),
            }
        };
        (0..predicted_kpa.len()).map(frame).collect()
    }
}
