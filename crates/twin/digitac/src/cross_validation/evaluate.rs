//! One division of the presses: test setup, twin and baselines are fitted to its training presses
//! and evaluated on the held-out ones.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};
use twintac_depth_table::DepthTable;
use twintac_recording::Recording;

use super::new_taxel;
use super::ood::{OodDetection, ood_detection};
use crate::bench_fit::{fit_radius, radius_weights};
use crate::{
    Baselines, BenchEstimate, BenchSettings, Certainty, CertaintyScore, Contact, DigitacError, Errors, Fold,
    PairSettings, PairedPress, Places, Scale, Score, Taxels, TrainSettings, TrainingData, Twin, Variant,
    calibrate, choose, evaluate, pair, recalibrate, refine_bench, score_certainty, train,
};

/// A recording, the tables of its locations, and the settings from which twins are made.
pub struct Bench<'a> {
    /// The presses.
    pub recording: &'a Recording,
    /// The locations of the presses.
    pub places: &'a Places,
    /// Tables of all locations, for each tip radius of the settings, or for the described tip if
    /// there are none; `[n_radii][n_places]`.
    pub tables: &'a [Vec<DepthTable>],
    /// Contacts at the locations; `[n_places]`.
    pub contacts: &'a [Contact],
    /// Presses whose locations are in the same square of this side belong together, mm. `None`:
    /// intervals are not evaluated, because this takes several times as long.
    pub intervals_block_mm: Option<f64>,
    /// Settings of the setup calibration.
    pub bench: &'a BenchSettings,
    /// Settings of the pairing.
    pub pair: &'a PairSettings,
    /// Settings of the training.
    pub train: &'a TrainSettings,
    /// Seed of the training.
    pub seed: u64,
    /// Ports and excluded taxels from the sensor's description.
    pub taxels: &'a Taxels,
}

/// Errors on the held-out presses of one division.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FoldEvaluation {
    /// The held-out file, indenter or taxel; empty if presses were drawn.
    pub held_out: String,
    /// Number of scored presses.
    pub n_presses: usize,
    /// The variant that validation presses chose.
    pub variant: Variant,
    /// Its errors.
    pub twin: Errors,
    /// The errors of each variant.
    pub variants: BTreeMap<Variant, Errors>,
    /// Errors of the parametric baseline (a power of depth times a function of distance). `None`
    /// for a held-out taxel, because the baseline has no gain for it.
    pub kernel: Option<Errors>,
    /// The tip radius from the training presses, mm, if it was fitted.
    pub tip_radius_mm: Option<f64>,
    /// The intervals of the twin's readings, if they were evaluated.
    #[serde(default)]
    pub certainty: Option<CertaintyScore>,
    /// How well held-out contacts are detected as out of distribution, if they are of another kind
    /// than the training contacts.
    #[serde(default, alias = "told_apart")]
    pub ood_detection: Option<OodDetection>,
    /// Number of frames deeper than the simulation. They are scored all the same.
    pub n_frames_not_simulated: usize,
    /// Number of all scored frames.
    pub n_frames: usize,
}

/// Fits test setup, twin and baselines to the training and validation presses of a division, and
/// evaluates them on the test presses. If a file has no training presses, its contact height comes
/// from its first presses, which are not scored ([`recalibrate`]).
///
/// # Errors
/// Those of the fits; too few presses.
pub fn evaluate_fold(bench: &Bench<'_>, fold: &Fold) -> Result<FoldEvaluation, DigitacError> {
    let (recording, places) = (bench.recording, bench.places);
    let taxels = bench.taxels;
    let left_out = &taxels.left_out;
    let split = &fold.split;
    let training = [&split.train[..], &split.validation].concat();
    let known = fold.taxel.map(|taxel| new_taxel::without(recording, taxel));
    let known = known.as_ref().unwrap_or(recording);

    let settings = BenchSettings {
        n_blocks: 0,
        ..bench.bench.clone()
    };
    let mut found = BenchEstimate::nominal();
    if bench.tables.len() > 1 {
        found = fit_radius(known, places, bench.tables, &training, &settings, taxels)?;
    }
    let tables = bench.tables_at(&found);
    let mut fitted = refine_bench(known, places, &tables, &training, &found, &settings, taxels)?;
    let whole = pair(recording, places, &tables, &fitted, bench.pair)?;
    let scale = Scale::of(&whole, left_out.clone());
    let pairs = match fold.taxel {
        Some(_) => pair(known, places, &tables, &fitted, bench.pair)?,
        None => whole,
    };

    let mut train_settings = bench.train.clone();
    if fold.taxel.is_some() {
        let variants = train_settings.variants().iter().copied();
        train_settings.variants = Some(variants.filter(|variant| !variant.has_perceptron()).collect());
    }
    let mut trained = train(
        &pairs,
        &recording.taxels,
        split,
        &scale,
        &train_settings,
        bench.seed,
        &mut |_| ControlFlow::Continue(()),
    )?;
    let kernel = match fold.taxel {
        None => Some(Baselines::fit(
            &pairs,
            &training,
            &bench.taxels.ports_mm,
            left_out,
        )?),
        Some(_) => None,
    };
    let chosen = choose(&trained)?;
    let twin = chosen.twin.clone();
    let variant = twin.variant();

    let certainty = bench.certainty((fold, variant), &pairs, &tables, &fitted, &scale)?;
    let test = bench.touch_new_files(fold, &training, &tables, &twin, &mut fitted)?;
    let pairs = pair(recording, places, &tables, &fitted, bench.pair)?;
    if let Some(taxel) = fold.taxel {
        for candidate in &mut trained {
            candidate.twin = new_taxel::with_gain(&candidate.twin, taxel, &pairs, &training, left_out)?;
        }
    }
    let by_place = (places, bench.contacts);
    let sure = |certainty| score_certainty((&twin, certainty), &pairs, by_place, &test, &scale);
    let evaluations = trained
        .iter()
        .map(|candidate| evaluate(&candidate.twin, &pairs, &test, &scale, kernel.as_ref()));
    let errors = |score: &Score| match fold.taxel {
        Some(taxel) => score.by_taxel.get(taxel).copied().unwrap_or_default(),
        None => score.overall,
    };
    let mut evaluated = FoldEvaluation {
        held_out: fold.held_out.clone(),
        n_presses: test.len(),
        variant,
        twin: Errors::default(),
        variants: BTreeMap::new(),
        kernel: None,
        tip_radius_mm: found.tip_radius_mm.map(|radius| radius.value),
        certainty: certainty.as_ref().map(sure),
        ood_detection: ood_detection(fold, &test, &pairs, places, bench.contacts),
        n_frames_not_simulated: 0,
        n_frames: 0,
    };
    for evaluation in evaluations {
        let own = errors(&evaluation.twin);
        evaluated.variants.insert(evaluation.variant, own);
        if evaluation.variant == variant {
            evaluated.twin = own;
            evaluated.kernel = evaluation.kernel.as_ref().map(errors);
            evaluated.n_frames_not_simulated = evaluation.twin.n_frames_not_simulated;
            evaluated.n_frames = evaluation.twin.n_frames;
        }
    }
    Ok(evaluated)
}

impl Bench<'_> {
    /// The intervals of a division's twin, if they are to be evaluated.
    fn certainty(
        &self,
        (fold, variant): (&Fold, Variant),
        pairs: &[PairedPress],
        tables: &[DepthTable],
        fitted: &BenchEstimate,
        scale: &Scale,
    ) -> Result<Option<Certainty>, DigitacError> {
        let (Some(block_mm), None) = (self.intervals_block_mm, fold.taxel) else {
            return Ok(None);
        };
        let data = TrainingData {
            recording: self.recording,
            presses: pairs,
            places: self.places,
            tables,
            contacts: self.contacts,
            bench: fitted,
            bench_settings: self.bench,
            taxels: self.taxels,
            train: self.train,
            seed: self.seed,
            block_mm,
            scale,
        };
        calibrate(&data, &fold.split, variant)
    }

    /// Adds the contact heights of files without training presses. Returns the presses that remain
    /// for the evaluation.
    fn touch_new_files(
        &self,
        fold: &Fold,
        training: &[usize],
        tables: &[DepthTable],
        twin: &Twin,
        fitted: &mut BenchEstimate,
    ) -> Result<Vec<usize>, DigitacError> {
        let file = |&press: &usize| &self.recording.presses[press].mounting;
        let known: BTreeSet<&String> = training.iter().map(file).collect();
        let files: BTreeSet<&String> = fold.split.test.iter().map(file).collect();
        let mut test = fold.split.test.clone();
        for file in files.difference(&known) {
            let contact = recalibrate(
                self.recording,
                (self.places, tables),
                fitted,
                twin,
                file,
                self.bench.contact_offset_limit_mm,
                &self.taxels.left_out,
            )?;
            if let Some(contact) = contact {
                test.retain(|press| !contact.used.contains(press));
                fitted
                    .contact_offset_mm
                    .insert(contact.file, contact.contact_offset_mm);
            }
        }
        Ok(test)
    }

    /// The table of each location for the fitted tip radius.
    fn tables_at(&self, found: &BenchEstimate) -> Vec<DepthTable> {
        let (Some(radius), true) = (found.tip_radius_mm, self.tables.len() > 1) else {
            return self.tables[0].clone();
        };
        let ln_radii: Vec<f64> = self.bench.radii_mm().iter().map(|radius| radius.ln()).collect();
        let weights = radius_weights(&ln_radii, radius.value.ln());
        let at = |place: usize| {
            let of_radii = self.tables.iter().map(|tables| &tables[place]);
            DepthTable::blend(&of_radii.zip(weights.iter().copied()).collect::<Vec<_>>())
        };
        (0..self.tables[0].len()).map(at).collect()
    }
}
