//! A bench, and its barometers, fitted to few presses: what these cannot tell stays near what was learned of another sensor.

use std::collections::BTreeSet;

use twintac_depth_table::DepthTable;
use twintac_recording::Recording;

use super::problem::{Along, BenchProblem};
use super::search::in_order;
use super::simulated::{bare_features, curves, follow_each_other};
use super::{BenchEstimate, BenchSettings, Estimate, Places};
use crate::numerics::Unknown;
use crate::physical_fit::{Elastic, Fitted, Posterior, Pressures, Prior, Series, fit_near_learned};
use crate::{DigitacError, Features, Gains};

/// Presses before one that is fitted to, which the gel still remembers.
const REMEMBERED: usize = 2;

/// By how much two benches differ: standard deviations of the unknowns of a fit.
pub(super) struct BenchWidths {
    pub(super) contact_offset_mm: f64,
    pub(super) ln_stiffness: f64,
    /// Of a port's place along an axis, and of all ports' radius.
    pub(super) port_mm: f64,
    /// Of a coefficient of the smooth factor.
    pub(super) factor: f64,
}

const USUAL: BenchWidths = BenchWidths {
    contact_offset_mm: 0.15,
    ln_stiffness: 0.3,
    port_mm: 0.1,
    factor: 0.1,
};

/// Fits bench and barometers to the presses `used`. Of the bench, its contact heights and stiffness are fitted, and ports and smooth factor where
/// `learned` has them; of the barometers, gains, port law and memory.
pub(crate) fn fit_near_learned_bench(
    recording: &Recording,
    (places, tables): (&Places, &[DepthTable]),
    used: &BTreeSet<usize>,
    (learned, gains): (&BenchEstimate, &Gains),
    left_out: &BTreeSet<usize>,
) -> Result<(BenchEstimate, Posterior), DigitacError> {
    let n_taxels = recording.taxels.len();
    let curves = vec![curves(places, tables, n_taxels)?];
    let presses = remembered(recording, used);
    let touch_z_mm = |index: usize| {
        let request = &places.requests[places.of_press[index]];
        request.gel_from_indenter_at_touch.position_mm.z
    };
    let all = recording.presses.iter().enumerate();
    let mut features: Vec<Features> = all
        .map(|(index, press)| bare_features(press, touch_z_mm(index)))
        .collect();
    if learned.has_history && !features.is_empty() {
        follow_each_other(&recording.presses, &mut features);
    }
    for index in 0..features.len() {
        if index == 0 || !presses.contains(&(index - 1)) {
            features[index].since_previous_s = None;
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
        readings_kpa: &recording.presses[index].taxels_kpa,
        valid: &recording.presses[index].valid,
        is_used: used.contains(&index),
    };
    let settings = BenchSettings {
        tip_radii_mm: Vec::new(),
        ..BenchSettings::default()
    };
    let problem = BenchProblem::new(
        presses.iter().map(along).collect(),
        &curves,
        &[],
        n_taxels,
        &settings,
    );
    let near = NearLearned {
        problem: problem.as_learned(learned),
        learned,
        prior: Prior::beside(used.len()),
    };
    let series = Series::new(
        &presses.iter().map(fitted).collect::<Vec<_>>(),
        n_taxels,
        left_out,
    );
    let posterior = fit_near_learned(&near, &series, gains, near.prior, left_out)?;
    let estimate = |value: &dyn Fn(&[f64]) -> f64| Estimate {
        value: value(posterior.values()),
        uncertainty: posterior.uncertainty(&|values, _| value(values)),
    };
    let has_taught = |mounting: &str| {
        let mut mountings = used.iter().map(|&index| &recording.presses[index].mounting);
        mountings.any(|taught| taught == mounting)
    };
    let bench = BenchEstimate {
        tip_radius_mm: learned.tip_radius_mm,
        has_history: learned.has_history,
        gains: Some(posterior.gains.clone()),
        deviation_percent: 100.0 * posterior.deviation,
        ..near.problem.estimate(posterior.values(), &estimate, &has_taught)
    };
    Ok((bench, posterior))
}

/// The presses `used` with those before them that the gel remembers, in the order in which it felt them.
fn remembered(recording: &Recording, used: &BTreeSet<usize>) -> Vec<usize> {
    let is_remembered = |index: usize| (index..=index + REMEMBERED).any(|later| used.contains(&later));
    let mountings = recording.presses.iter().map(|press| &press.mounting[..]);
    let ordered = in_order(mountings).into_iter();
    ordered.filter(|&index| is_remembered(index)).collect()
}

/// A bench whose unknowns are pulled to what was learned.
struct NearLearned<'a> {
    problem: BenchProblem<'a>,
    learned: &'a BenchEstimate,
    prior: Prior,
}

impl Elastic for NearLearned<'_> {
    fn unknowns(&self) -> Vec<Unknown> {
        let mut unknowns = self.problem.unknowns();
        let learned = self.problem.learned(self.learned, &USUAL);
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
