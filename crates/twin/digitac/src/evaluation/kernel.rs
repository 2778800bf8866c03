//! The parametric baseline: a curve that is a power of depth times a smooth function of distance,
//! with the same model of barometers as the twin.
//!
//! It knows no gel, no shape and no neighbouring taxels. On presses of one indenter, the benefit of
//! the finite elements is the difference between the errors of this baseline and of a twin.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::baseline;
use crate::features::TIME_CONSTANTS_S;
use crate::numerics::{Unknown, mirrored_splines};
use crate::physical_fit::{BarometerModel, Elastic, Fitted, Pressures, Series, Slope, fit};
use crate::{DigitacError, Features, Gains, PairedPress};

/// Number of intervals of the function of distance, from a port to half the largest distance of a
/// press.
const N_INTERVALS: usize = 8;
/// Number of coefficients of its cubic B-spline, whose slope is zero at the port.
const N_COEFFICIENTS: usize = N_INTERVALS + 2;
/// Initial, smallest and largest power of depth.
const POWER: [f64; 3] = [1.5, 0.5, 4.0];
/// Largest difference of contact heights from those of the twin, mm.
const OFFSET_LIMIT_MM: f64 = 0.4;
/// Smallest depth, mm, or force, N, that counts as contact.
const SMALLEST: f64 = 1e-6;
/// Regularization of all unknowns towards their start. It fixes the common factor of gains and
/// coefficients.
const PULL: f64 = 1e-6;

/// One curve for each indenter.
pub(crate) struct Kernel {
    by_indenter: BTreeMap<String, Fit>,
}

struct Fit {
    curve: Curve,
    values: Vec<f64>,
    gains: Gains,
}

/// What a curve needs to know of the test setup.
#[derive(Clone)]
struct Curve {
    ports_mm: Vec<[f64; 2]>,
    mountings: Vec<String>,
    reach_mm: f64,
}

impl Kernel {
    /// Fits training presses among recorded ones. `ports_mm` are the ports' locations in the gel's
    /// plane; `[n_taxels]`.
    pub(crate) fn fit(
        recorded: &[PairedPress],
        training_presses: &[usize],
        ports_mm: &[[f64; 2]],
        left_out: &BTreeSet<usize>,
    ) -> Result<Self, DigitacError> {
        let mut groups: BTreeMap<String, Vec<&PairedPress>> = BTreeMap::new();
        for &index in training_presses {
            groups
                .entry(recorded[index].indenter.clone())
                .or_default()
                .push(&recorded[index]);
        }
        let fit = |(indenter, mut presses): (String, Vec<&PairedPress>)| {
            presses.sort_by(|a, b| a.mounting.cmp(&b.mounting));
            Ok((indenter, Fit::new(&presses, ports_mm, left_out)?))
        };
        Ok(Self {
            by_indenter: groups.into_iter().map(fit).collect::<Result<_, DigitacError>>()?,
        })
    }

    /// Predicted readings of a press from rest, kPa; `[n_frames][n_taxels]`. Zeros for an indenter
    /// that was not fitted.
    #[must_use]
    pub(crate) fn predict(&self, press: &PairedPress) -> Vec<Vec<f64>> {
        let Some(fit) = self.by_indenter.get(&press.indenter) else {
            return baseline::zero(press);
        };
        let columns = fit.curve.columns(press, &fit.values);
        let frames = 0..press.features.n_frames();
        let elastic = frames.map(|i| {
            columns
                .iter()
                .zip(&fit.gains.gain)
                .map(|(own, gain)| gain * own.kpa[i])
                .collect()
        });
        let rested = Features {
            since_previous_s: None,
            ..press.features.clone()
        };
        fit.gains
            .remember(&[&rested], vec![elastic.collect()])
            .swap_remove(0)
    }
}

impl Fit {
    fn new(
        presses: &[&PairedPress],
        ports_mm: &[[f64; 2]],
        left_out: &BTreeSet<usize>,
    ) -> Result<Self, DigitacError> {
        let mut mountings: Vec<String> = presses.iter().map(|press| press.mounting.clone()).collect();
        mountings.dedup();
        let places = presses.iter().map(|press| press.place_mm);
        let far_mm = places.flat_map(|place| ports_mm.iter().map(move |port| distance_mm(place, *port)));
        let curve = Curve {
            ports_mm: ports_mm.to_vec(),
            mountings,
            reach_mm: (0.5 * far_mm.fold(0.0, f64::max)).max(1e-3),
        };
        let rested: Vec<Features> = presses
            .iter()
            .map(|press| Features {
                since_previous_s: None,
                ..press.features.clone()
            })
            .collect();
        let fitted: Vec<Fitted<'_>> = presses
            .iter()
            .zip(&rested)
            .map(|(press, features)| Fitted {
                mounting: &press.mounting,
                features,
                readings_kpa: &press.readings_kpa,
                valid: &press.valid,
                is_used: true,
            })
            .collect();
        let model = BarometerModel::new(&rested, &TIME_CONSTANTS_S, false);
        let series = Series::new(&fitted, ports_mm.len(), left_out);
        let problem = CurveProblem {
            curve: &curve,
            presses,
            series: &series,
        };
        let solution = fit(&problem, &series, &model, left_out, None)?;
        Ok(Self {
            values: solution.values,
            gains: solution.gains,
            curve,
        })
    }
}

/// The curve of one taxel along a press, with its derivatives.
struct TaxelCurve {
    kpa: Vec<f64>,
    by_offset: Vec<f64>,
    /// Derivatives with respect to the power, its growth with distance, and the coefficients.
    by_shape: Vec<Vec<f64>>,
}

impl Curve {
    /// Number of unknowns after the offsets: the power, its growth over the reach, and the
    /// coefficients.
    fn n_shape(&self) -> usize {
        2 + N_COEFFICIENTS
    }

    fn columns(&self, press: &PairedPress, values: &[f64]) -> Vec<TaxelCurve> {
        let (offsets_mm, shape) = values.split_at(self.mountings.len());
        let mounting = self
            .mountings
            .iter()
            .position(|mounting| *mounting == press.mounting);
        let is_static = press.features.n_frames() < 2;
        let offset_mm = mounting
            .filter(|_| !is_static)
            .map_or(0.0, |index| offsets_mm[index]);
        let drive: Vec<f64> = if is_static {
            press.features.force_n.clone()
        } else {
            press
                .features
                .depth_mm
                .iter()
                .map(|depth_mm| depth_mm + offset_mm)
                .collect()
        };
        let of_port = |port: &[f64; 2]| {
            let share = (distance_mm(press.place_mm, *port) / self.reach_mm).min(1.0);
            let basis: [f64; N_COEFFICIENTS] = mirrored_splines(share * N_INTERVALS as f64);
            let height: f64 = basis.iter().zip(&shape[2..]).map(|(b, a)| a * b).sum();
            let power = shape[0] + shape[1] * share;
            let grown: Vec<f64> = drive
                .iter()
                .map(|d| if *d > SMALLEST { d.powf(power) } else { 0.0 })
                .collect();
            let logarithm: Vec<f64> = drive.iter().map(|d| d.max(SMALLEST).ln()).collect();
            let by_power: Vec<f64> = grown
                .iter()
                .zip(&logarithm)
                .map(|(g, ln)| height * g * ln)
                .collect();
            let mut by_shape = vec![by_power.clone(), by_power.iter().map(|v| share * v).collect()];
            by_shape.extend(
                basis
                    .iter()
                    .map(|b| grown.iter().map(|g| b * g).collect::<Vec<f64>>()),
            );
            TaxelCurve {
                kpa: grown.iter().map(|g| height * g).collect(),
                by_offset: if is_static {
                    vec![0.0; drive.len()]
                } else {
                    grown
                        .iter()
                        .zip(&drive)
                        .map(|(g, d)| height * power * g / d.max(SMALLEST))
                        .collect()
                },
                by_shape,
            }
        };
        self.ports_mm.iter().map(of_port).collect()
    }
}

fn distance_mm(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

struct CurveProblem<'a> {
    curve: &'a Curve,
    presses: &'a [&'a PairedPress],
    series: &'a Series,
}

impl Elastic for CurveProblem<'_> {
    fn unknowns(&self) -> Vec<Unknown> {
        let unknown = |start: f64, bounds: [f64; 2]| Unknown {
            start,
            bounds,
            center: start,
            pull: PULL,
        };
        let mut unknowns =
            vec![unknown(0.0, [-OFFSET_LIMIT_MM, OFFSET_LIMIT_MM]); self.curve.mountings.len()];
        unknowns.push(unknown(POWER[0], [POWER[1], POWER[2]]));
        unknowns.push(unknown(0.0, [-3.0, 3.0]));
        let fall = |j: usize| (-(3.0 * j as f64 / N_INTERVALS as f64).powi(2)).exp();
        unknowns.extend((0..N_COEFFICIENTS).map(|j| unknown(fall(j), [-5.0, 5.0])));
        unknowns
    }

    fn pressures(&self, values: &[f64], with_slopes: bool) -> Result<Pressures, DigitacError> {
        let (n_taxels, n_frames) = (self.curve.ports_mm.len(), self.series.n_frames());
        let all = 0..n_frames;
        let rows = |frames: &Range<usize>| vec![vec![0.0; frames.len()]; n_taxels];
        let mut kpa = rows(&all);
        let n_offsets = self.curve.mountings.len();
        let slope = |unknown: usize, frames: Range<usize>| Slope {
            unknown,
            taxel: None,
            kpa: rows(&frames),
            frames,
        };
        let of_mounting = |name: &String| self.series.mountings[name].clone();
        let mut slopes: Vec<Slope> = Vec::new();
        if with_slopes {
            let offsets = self.curve.mountings.iter().enumerate();
            slopes.extend(offsets.map(|(unknown, name)| slope(unknown, of_mounting(name))));
            slopes.extend((0..self.curve.n_shape()).map(|s| slope(n_offsets + s, all.clone())));
        }
        for (press, frames) in self.presses.iter().zip(&self.series.presses) {
            let mounting = self
                .curve
                .mountings
                .iter()
                .position(|name| *name == press.mounting);
            for (k, column) in self.curve.columns(press, values).into_iter().enumerate() {
                kpa[k][frames.clone()].copy_from_slice(&column.kpa);
                if !with_slopes {
                    continue;
                }
                if let Some(offset) = mounting {
                    let first = slopes[offset].frames.start;
                    let own = frames.start - first..frames.end - first;
                    slopes[offset].kpa[k][own].copy_from_slice(&column.by_offset);
                }
                for (slope, own) in slopes[n_offsets..].iter_mut().zip(&column.by_shape) {
                    slope.kpa[k][frames.clone()].copy_from_slice(own);
                }
            }
        }
        Ok(Pressures { kpa, slopes })
    }
}
