//! A test setup and its barometers, fitted to few presses. What these do not determine stays near
//! the values learned on another sensor.

use std::collections::{BTreeMap, BTreeSet};

use twintac_depth_table::DepthTable;
use twintac_recording::Recording;

use super::problem::{Along, BenchProblem};
use super::search::in_order;
use super::simulated::{bare_features, curves, follow_each_other};
use super::widths::BenchWidths;
use super::{BenchEstimate, BenchSettings, Estimate, Places, Taxels};
use crate::numerics::Unknown;
use crate::physical_fit::{
    Elastic, Fitted, Posterior, Pressures, Prior, Series, fit_near_learned, information,
};
use crate::{DigitacError, Features, Gains};

/// Number of presses before a fitted one whose relaxation is still in the gel.
const REMEMBERED: usize = 2;

/// The information of each press about all unknowns, as a matrix, and the prior information about
/// each unknown.
pub(crate) type Information = (BTreeMap<usize, Vec<f64>>, Vec<f64>);

/// A test setup and its barometers as learned elsewhere, with presses that they were not fitted to.
#[derive(Clone, Copy)]
pub(crate) struct LearnedBench<'a> {
    pub(crate) recording: &'a Recording,
    pub(crate) places: &'a Places,
    pub(crate) tables: &'a [DepthTable],
    pub(crate) bench: &'a BenchEstimate,
    pub(crate) gains: &'a Gains,
    pub(crate) left_out: &'a BTreeSet<usize>,
}

impl LearnedBench<'_> {
    /// Fits setup and barometers to the presses `used`. Of the setup, contact heights and stiffness
    /// are fitted, and ports and the correction factor where it has them; of the barometers, gains,
    /// static nonlinearity and relaxation.
    pub(crate) fn fit(&self, used: &BTreeSet<usize>) -> Result<(BenchEstimate, Posterior), DigitacError> {
        let measured = |index: usize| &self.recording.presses[index].taxels_kpa[..];
        self.with_presses(used, &measured, |near, series| {
            let posterior = fit_near_learned(near, series, self.gains, near.prior, self.left_out)?;
            let estimate = |value: &dyn Fn(&[f64]) -> f64| Estimate {
                value: value(posterior.values()),
                uncertainty: posterior.uncertainty(&|values, _| value(values)),
            };
            let is_trained_on = |mounting: &str| {
                let mut mountings = used.iter().map(|&index| &self.recording.presses[index].mounting);
                mountings.any(|trained_on| trained_on == mounting)
            };
            let bench = BenchEstimate {
                tip_radius_mm: self.bench.tip_radius_mm,
                has_history: self.bench.has_history,
                gains: Some(posterior.gains.clone()),
                deviation_percent: 100.0 * posterior.deviation,
                ..near
                    .problem
                    .estimate(posterior.values(), &estimate, &is_trained_on)
            };
            Ok((bench, posterior))
        })
    }

    /// The information that each of some presses would give about all unknowns if it read the
    /// predictions, `[n_presses][n_frames][n_taxels]` of the recording; and the prior information
    /// about each unknown. See [`information`].
    pub(crate) fn information(
        &self,
        presses: &BTreeSet<usize>,
        predicted_kpa: &[Vec<Vec<f64>>],
    ) -> Result<Information, DigitacError> {
        let predicted = |index: usize| &predicted_kpa[index][..];
        self.with_presses(presses, &predicted, |near, series| {
            let (matrices, known) = information(near, series, self.gains, near.prior, self.left_out)?;
            let all = remembered(self.recording, presses).into_iter().zip(matrices);
            Ok((all.filter(|(index, _)| presses.contains(index)).collect(), known))
        })
    }

    /// Calls `work` with the presses `used` and those whose relaxation is still in the gel.
    fn with_presses<'r, T>(
        &'r self,
        used: &BTreeSet<usize>,
        readings_kpa: &dyn Fn(usize) -> &'r [Vec<f64>],
        work: impl FnOnce(&NearLearned<'_>, &Series) -> Result<T, DigitacError>,
    ) -> Result<T, DigitacError> {
        let (recording, places) = (self.recording, self.places);
        let n_taxels = recording.taxels.len();
        let curves = vec![curves(places, self.tables, n_taxels)?];
        let presses = remembered(recording, used);
        let touch_z_mm = |index: usize| {
            let request = &places.requests[places.of_press[index]];
            request.gel_from_indenter_at_touch.position_mm.z
        };
        let all = recording.presses.iter().enumerate();
        let mut features: Vec<Features> = all
            .map(|(index, press)| bare_features(press, touch_z_mm(index)))
            .collect();
        if self.bench.has_history && !features.is_empty() {
            follow_each_other(&recording.presses, &mut features);
        }
        for (index, features) in features.iter_mut().enumerate() {
            if index == 0 || !presses.contains(&(index - 1)) {
                features.since_previous_s = None;
            }
        }
        let along = |&index: &usize| Along {
            press: &recording.presses[index],
            place: places.of_press[index],
            touch_z_mm: touch_z_mm(index),
            is_used: used.contains(&index),
        };
        let fitted = |&index: &usize| Fitted {
            mounting: &recording.presses[index].mounting,
            features: &features[index],
            readings_kpa: readings_kpa(index),
            valid: &recording.presses[index].valid,
            is_used: used.contains(&index),
        };
        let (settings, unknown) = (BenchSettings::default(), Taxels::default());
        let along = presses.iter().map(along).collect();
        let problem = BenchProblem::new(along, &curves, &[], n_taxels, (&settings, &unknown));
        let near = NearLearned {
            problem: problem.near_learned(self.bench),
            learned: self.bench,
            prior: Prior::beside(used.len()),
        };
        let fitted: Vec<Fitted<'_>> = presses.iter().map(fitted).collect();
        work(&near, &Series::new(&fitted, n_taxels, self.left_out))
    }
}

/// The presses `used` and those before them whose relaxation is still in the gel, in the order of
/// the recording.
fn remembered(recording: &Recording, used: &BTreeSet<usize>) -> Vec<usize> {
    let is_remembered = |index: usize| (index..=index + REMEMBERED).any(|later| used.contains(&later));
    let mountings = recording.presses.iter().map(|press| &press.mounting[..]);
    let ordered = in_order(mountings).into_iter();
    ordered.filter(|&index| is_remembered(index)).collect()
}

/// A test setup whose unknowns are regularized towards the learned values.
struct NearLearned<'a> {
    problem: BenchProblem<'a>,
    learned: &'a BenchEstimate,
    prior: Prior,
}

impl Elastic for NearLearned<'_> {
    fn unknowns(&self) -> Vec<Unknown> {
        let mut unknowns = self.problem.unknowns();
        let learned = self.problem.learned(self.learned, &BenchWidths::USUAL);
        debug_assert_eq!(unknowns.len(), learned.len());
        for (unknown, (value, width)) in unknowns.iter_mut().zip(learned) {
            self.prior.pull(unknown, value, width);
        }
        unknowns
    }

    fn pressures(&self, values: &[f64], with_slopes: bool) -> Result<Pressures, DigitacError> {
        self.problem.pressures(values, with_slopes)
    }
}
