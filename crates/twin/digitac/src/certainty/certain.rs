//! Intervals and OOD scores of a twin.

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, Ranges};

use super::Contact;
use super::spread::{Known, Spread};
use super::training_set::TrainingSet;

/// Uncertainty of a twin, learned from presses that were left out when it was fitted again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Certainty {
    /// Fraction of the readings that the intervals are made to cover, %.
    pub level_percent: f64,
    /// Contacts with a larger OOD score are flagged.
    pub threshold: f64,
    /// Numbers of presses and of readings that the intervals were learned from.
    pub learned_from: [usize; 2],
    #[serde(alias = "taught")]
    pub(super) training_set: TrainingSet,
    pub(super) spread: Spread,
    /// Half an interval over the spread, for non-contact frames and for contact.
    pub(super) factors: [f64; 2],
    /// Relative widening of the intervals for each unit of the OOD score above 1.
    pub(super) growth: f64,
}

impl Checked for Certainty {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            level_percent,
            threshold,
            learned_from: _,
            training_set,
            spread,
            factors,
            growth,
        } = self;
        ranges.number("level_percent", *level_percent, 0.0..=100.0);
        ranges.number("threshold", *threshold, 0.0..=1e9);
        ranges.inside("training_set", training_set);
        ranges.inside("spread", spread);
        ranges.numbers("factors", factors, 2, 0.0..=1e12);
        ranges.number("growth", *growth, 0.0..=1e6);
    }
}

/// Uncertainty of a twin along a press. All vectors have the same length, `n_frames`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PressCertainty {
    /// Half the width of the interval around each reading, kPa; `[n_frames][n_taxels]`.
    pub half_width_kpa: Vec<Vec<f64>>,
    /// OOD score of the contact: below about 1, it lies between training contacts.
    pub ood_score: Vec<f64>,
    /// Whether the contact is out of distribution, so that readings and intervals cannot be
    /// trusted.
    pub is_out_of_distribution: Vec<bool>,
}

impl Certainty {
    /// OOD score of a contact at a depth: below about 1, it lies between training contacts in
    /// location, depth and contact geometry. 0 above the gel. Allocates no memory.
    #[must_use]
    pub fn ood_score(&self, contact: &Contact, depth_mm: f64) -> f64 {
        self.training_set
            .ood_score(contact.place_mm, &contact.underside, depth_mm)
    }

    /// Half widths of the intervals around the readings of a frame, kPa; `[n_taxels]`.
    /// `rates_kpa_per_s` are the rates of change since the previous frame. Allocates no memory.
    pub(crate) fn half_widths_kpa(
        &self,
        (ood_score, depth_mm): (f64, f64),
        readings_kpa: &[f64],
        rates_kpa_per_s: &[f64],
        half_widths_kpa: &mut [f64],
    ) {
        let largest_kpa = readings_kpa.iter().fold(0.0_f64, |most, kpa| most.max(kpa.abs()));
        let factor = self.factor(depth_mm) * self.widening(ood_score);
        let rows = readings_kpa.iter().zip(rates_kpa_per_s);
        for (half_width, (&reading_kpa, &rate_kpa_per_s)) in half_widths_kpa.iter_mut().zip(rows) {
            let known = Known {
                reading_kpa,
                rate_kpa_per_s,
                largest_kpa,
                ood_score: ood_score.min(1.0),
            };
            *half_width = factor * self.spread.kpa(&known);
        }
    }

    /// Uncertainty along a press. `contact` gives the contact of a frame.
    pub fn along<'c>(
        &self,
        contact: impl Fn(usize) -> &'c Contact,
        time_s: &[f64],
        depth_mm: &[f64],
        readings_kpa: &[Vec<f64>],
    ) -> PressCertainty {
        let mut found = PressCertainty::default();
        for (frame, row) in readings_kpa.iter().enumerate() {
            let rates = rates_kpa_per_s(time_s, readings_kpa, frame);
            let ood_score = self.ood_score(contact(frame), depth_mm[frame]);
            let mut half_widths_kpa = vec![0.0; row.len()];
            self.half_widths_kpa((ood_score, depth_mm[frame]), row, &rates, &mut half_widths_kpa);
            found.half_width_kpa.push(half_widths_kpa);
            found.ood_score.push(ood_score);
            found.is_out_of_distribution.push(ood_score > self.threshold);
        }
        found
    }

    pub(super) fn factor(&self, depth_mm: f64) -> f64 {
        self.factors[usize::from(depth_mm > 0.0)]
    }

    fn widening(&self, ood_score: f64) -> f64 {
        1.0 + self.growth * (ood_score - 1.0).max(0.0)
    }
}

/// Rates of change of the readings at a frame, from the frame before, kPa/s; `[n_taxels]`.
pub(super) fn rates_kpa_per_s(time_s: &[f64], readings_kpa: &[Vec<f64>], frame: usize) -> Vec<f64> {
    let before = frame.saturating_sub(1);
    let since_s = (time_s[frame] - time_s[before]).max(1e-6);
    let pairs = readings_kpa[frame].iter().zip(&readings_kpa[before]);
    pairs.map(|(now, then)| (now - then) / since_s).collect()
}
