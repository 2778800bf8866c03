//! The presses, tables and unknowns that a bench is fitted with, and how well a guess explains them.

use std::collections::{BTreeMap, BTreeSet};

use twintac_depth_table::{DepthCurves, DepthTableSource};
use twintac_recording::{Control, Press, Recording};

use super::{BenchEstimate, BenchSettings, Estimate, Places, curves, features_along};
use crate::features::{Gains, Sample};
use crate::numerics::minimize;
use crate::{DigitacError, Features};

/// Frames of a press that the fit looks at.
const MAX_FRAMES: usize = 96;
/// Knots of curves between two radii.
const KNOTS: usize = 40;
/// A press that by itself would put the contact farther than this from its file's is worth a warning, mm.
const SUSPICIOUS_MM: f64 = 0.08;
/// Tolerance of a press's own contact height, mm.
const TOLERANCE_MM: f64 = 2e-3;

/// Values of all unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Guess {
    pub(crate) ln_radius: f64,
    pub(crate) offsets_mm: BTreeMap<String, f64>,
    pub(crate) ln_stiffness: f64,
}

pub(crate) struct Thinned {
    pub(crate) press: Press,
    place: usize,
    touch_z_mm: f64,
}

pub(crate) struct Problem<'a> {
    pub(crate) presses: Vec<Thinned>,
    /// `[n_radii][n_places]`; a single row if the indenter is as described.
    curves: Vec<Vec<DepthCurves>>,
    pub(crate) ln_radii: Vec<f64>,
    pub(crate) ln_stiffness_limits: [f64; 2],
    pub(crate) settings: &'a BenchSettings,
}

impl<'a> Problem<'a> {
    pub(crate) fn new(
        recording: &Recording,
        places: &Places,
        chosen: &[usize],
        source: &dyn DepthTableSource,
        settings: &'a BenchSettings,
    ) -> Result<Self, DigitacError> {
        let used: Vec<usize> = chosen
            .iter()
            .map(|&p| places.of_press[p])
            .collect::<BTreeSet<_>>()
            .into_iter()
            .collect();
        let forced = chosen
            .iter()
            .any(|&press| recording.presses[press].control == Control::Force);
        let ln_stiffness_limits = if forced && settings.tip_radii_mm.len() < 2 {
            settings.stiffness_limits.map(f64::ln)
        } else {
            [0.0, 0.0]
        };
        let here = Places {
            requests: used.iter().map(|&i| places.requests[i].clone()).collect(),
            of_press: Vec::new(),
        }
        .with_stiffness(ln_stiffness_limits[0].exp());
        let radii: Vec<Option<f64>> = match &settings.tip_radii_mm[..] {
            [] => vec![None],
            radii => radii.iter().copied().map(Some).collect(),
        };
        // All radii in one request: the source may work on them side by side.
        let requests: Vec<_> = radii
            .iter()
            .flat_map(|&radius| here.clone().with_tip_radius(radius).requests)
            .collect();
        let tables = source.depth_tables(&requests).map_err(DigitacError::Simulation)?;
        if tables.len() != requests.len() {
            return Err(DigitacError::DepthTableCount {
                expected: requests.len(),
                found: tables.len(),
            });
        }
        let curves = tables
            .chunks(used.len())
            .map(|tables| curves(&here, tables, recording.taxels.len()))
            .collect::<Result<_, _>>()?;
        let presses = chosen.iter().map(|&index| {
            let place = places.of_press[index];
            Thinned {
                press: thin(&recording.presses[index]),
                place: used.partition_point(|&other| other < place),
                touch_z_mm: places.requests[place].gel_from_indenter_at_touch.position_mm.z,
            }
        });
        let ln_radii = settings.tip_radii_mm.iter().map(|radius| radius.ln()).collect();
        Ok(Self {
            presses: presses.collect(),
            curves,
            ln_radii,
            ln_stiffness_limits,
            settings,
        })
    }

    pub(crate) fn n_places(&self) -> usize {
        self.curves[0].len()
    }

    pub(crate) fn n_blocks(&self) -> usize {
        let n = self.settings.n_blocks.min(self.n_places());
        if n < 2 { 0 } else { n }
    }

    /// The gains that fit best, and the mean over taxels of the mean absolute deviation, kPa.
    pub(crate) fn deviation(
        &self,
        curves: &[DepthCurves],
        guess: &Guess,
        without_block: Option<usize>,
    ) -> Result<(Gains, f64), DigitacError> {
        let bench = BenchEstimate {
            contact_offset_mm: guess
                .offsets_mm
                .iter()
                .map(|(file, mm)| (file.clone(), exactly(*mm)))
                .collect(),
            stiffness: Some(exactly(guess.ln_stiffness.exp())),
            ..BenchEstimate::nominal()
        };
        let kept: Vec<&Thinned> = self
            .presses
            .iter()
            .filter(|p| without_block.is_none_or(|block| p.place % self.n_blocks() != block))
            .collect();
        let features: Vec<Features> = kept
            .iter()
            .map(|p| features_along(&curves[p.place], &p.press, p.touch_z_mm, &bench))
            .collect::<Result<_, _>>()?;
        let samples: Vec<Sample<'_>> = kept
            .iter()
            .zip(&features)
            .map(|(p, features)| Sample {
                features,
                readings_kpa: &p.press.taxels_kpa,
                valid: &p.press.valid,
            })
            .collect();
        let memory = if features.iter().any(|f| f.n_frames() > 1) {
            &self.settings.time_constants_s[..]
        } else {
            &[]
        };
        let (gains, deviations_kpa) = Gains::fit(&samples, memory);
        let counted: Vec<f64> = deviations_kpa
            .iter()
            .enumerate()
            .filter(|(taxel, _)| !self.settings.left_out.contains(taxel))
            .map(|(_, deviation)| *deviation)
            .collect();
        let mean = counted.iter().sum::<f64>() / counted.len().max(1) as f64;
        Ok((gains, mean))
    }

    /// The curves of a radius between those simulated, by the polynomial in ln radius through all of them.
    pub(crate) fn curves_at(&self, ln_radius: f64) -> Result<Vec<DepthCurves>, DigitacError> {
        if self.ln_radii.len() < 2 {
            return Ok(self.curves[0].clone());
        }
        let weights: Vec<f64> = (0..self.ln_radii.len())
            .map(|i| {
                let others = self.ln_radii.iter().enumerate().filter(|(j, _)| *j != i);
                others
                    .map(|(_, other)| (ln_radius - other) / (self.ln_radii[i] - other))
                    .product()
            })
            .collect();
        (0..self.n_places())
            .map(|place| {
                let curves: Vec<&DepthCurves> = self.curves.iter().map(|row| &row[place]).collect();
                DepthCurves::blend(&curves, &weights, KNOTS)
                    .map_err(|source| DigitacError::DepthTable { index: place, source })
            })
            .collect()
    }

    /// Presses that touch elsewhere than the rest of their file, found with the gains fixed.
    pub(crate) fn odd_presses(
        &self,
        curves: &[DepthCurves],
        best: &Guess,
        gains: &Gains,
    ) -> Result<Vec<String>, DigitacError> {
        let reach_mm = self.settings.contact_offset_limit_mm;
        let mut odd = Vec::new();
        for p in self
            .presses
            .iter()
            .filter(|p| p.press.control == Control::Pose && reach_mm > 0.0)
        {
            let mut failure = None;
            let mut bench = BenchEstimate::nominal();
            let at = |extra_mm: f64| {
                bench.contact_offset_elsewhere_mm = best.offsets_mm[&p.press.mounting] + extra_mm;
                match features_along(&curves[p.place], &p.press, p.touch_z_mm, &bench) {
                    Ok(features) => self.own_deviation(&p.press, &gains.readings_kpa(&features)),
                    Err(error) => {
                        failure = Some(error);
                        f64::INFINITY
                    }
                }
            };
            let (extra_mm, _) = minimize(-reach_mm, reach_mm, TOLERANCE_MM, at);
            failure.map_or(Ok(()), Err)?;
            if extra_mm.abs() > SUSPICIOUS_MM {
                odd.push(format!(
                    "press {} touches {extra_mm:+.2} mm deeper than the rest of its file",
                    p.press.name
                ));
            }
        }
        Ok(odd)
    }

    fn own_deviation(&self, press: &Press, predicted: &[Vec<f64>]) -> f64 {
        let rows = press.taxels_kpa.iter().zip(predicted).zip(&press.valid);
        rows.flat_map(|((measured, predicted), valid)| {
            let taxels =
                (0..measured.len()).filter(|taxel| valid[*taxel] && !self.settings.left_out.contains(taxel));
            taxels.map(|taxel| (measured[taxel] - predicted[taxel]).abs())
        })
        .sum()
    }
}

pub(crate) fn exactly(value: f64) -> Estimate {
    Estimate {
        value,
        uncertainty: 0.0,
    }
}

/// A press with at most [`MAX_FRAMES`] frames.
fn thin(press: &Press) -> Press {
    let stride = press.time_s.len().div_ceil(MAX_FRAMES).max(1);
    fn every<T: Clone>(values: &[T], stride: usize) -> Vec<T> {
        values.iter().step_by(stride).cloned().collect()
    }
    Press {
        time_s: every(&press.time_s, stride),
        gel_from_indenter: every(&press.gel_from_indenter, stride),
        force_n: press.force_n.as_ref().map(|force_n| every(force_n, stride)),
        taxels_kpa: every(&press.taxels_kpa, stride),
        taxels_raw: Vec::new(),
        valid: every(&press.valid, stride),
        ..press.clone()
    }
}
