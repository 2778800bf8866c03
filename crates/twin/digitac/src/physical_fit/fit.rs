//! Fits barometers and the unknowns of the test setup to measured presses at the same time.
//!
//! The sum of absolute deviations is minimized, each over the largest reading of its file. Readings
//! are linear in the elastic reading that relaxation acts on, so each column of the Jacobian is a
//! derivative of the elastic reading, put through the same relaxation.

use std::collections::BTreeSet;
use std::ops::Range;

use twintac_fit::Quadratic;

use super::layout::{BarometerModel, Layout};
use super::prior::Prior;
use super::{Elastic, Posterior, Pressures, Series};
use crate::DigitacError;
use crate::features::{Gains, overstress_step, port_reading, port_slopes};
use crate::numerics::{Unknown, dot, fit_nonnegative, inverse_symmetric, minimize_robust};

/// Deviations below this fraction of the largest reading count quadratically, larger ones linearly.
const CORNER: f64 = 2e-3;

/// The result of a fit.
pub(crate) struct Solution {
    /// Values of the unknowns of the port pressures.
    pub(crate) values: Vec<f64>,
    pub(crate) gains: Gains,
    /// Weighted mean of the absolute deviations over the largest readings.
    pub(crate) deviation: f64,
}

/// Fits to the readings of a series, from a default start or from the result of another fit.
/// Unknowns that all taxels share do not depend on excluded taxels; these get gains of their own.
pub(crate) fn fit(
    elastic: &dyn Elastic,
    series: &Series,
    model: &BarometerModel,
    left_out: &BTreeSet<usize>,
    near: Option<&Solution>,
) -> Result<Solution, DigitacError> {
    let mut unknowns = elastic.unknowns();
    let n_elastic = unknowns.len();
    let gains = if let Some(near) = near {
        for (unknown, value) in unknowns.iter_mut().zip(&near.values) {
            unknown.start = *value;
        }
        near.gains.clone()
    } else {
        let start: Vec<f64> = unknowns.iter().map(|unknown| unknown.start).collect();
        start_gains(
            &elastic.pressures(&start, false)?,
            series,
            &model.time_constants_s,
        )
    };
    let largest_kpa = series
        .per_kpa
        .iter()
        .filter(|p| **p > 0.0)
        .map(|p| p.recip())
        .fold(0.0, f64::max);
    let layout = Layout {
        n_elastic,
        n_constants: model.time_constants_s.len(),
        largest_kpa,
        usual_gain: usual_gain(&gains, left_out),
    };
    unknowns.extend(layout.unknowns(&gains, model));
    let problem = Problem {
        elastic,
        series,
        left_out,
        layout: &layout,
    };
    let near = |x: &[f64]| problem.near(x);
    let x = minimize_robust(&unknowns, near, |x| problem.cost(x))?;
    Ok(Solution {
        gains: layout.gains(&x, series.weights.len()),
        deviation: problem.deviation(&x)?,
        values: x[..n_elastic].to_vec(),
    })
}

/// Fits to the readings of a series, with regularization towards values that were learned
/// elsewhere: `elastic` regularizes its own unknowns, `prior` the barometers towards `learned`.
pub(crate) fn fit_near_learned(
    elastic: &dyn Elastic,
    series: &Series,
    learned: &Gains,
    prior: Prior,
    left_out: &BTreeSet<usize>,
) -> Result<Posterior, DigitacError> {
    let (layout, unknowns) = near_learned(elastic, series, learned, prior, left_out);
    let problem = Problem {
        elastic,
        series,
        left_out,
        layout: &layout,
    };
    let x = minimize_robust(&unknowns, |x| problem.near(x), |x| problem.cost(x))?;
    let mut curvature = problem.near(&x)?.matrix;
    for (i, unknown) in unknowns.iter().enumerate() {
        curvature[i * unknowns.len() + i] += 2.0 * unknown.pull;
    }
    let is_free: Vec<bool> = unknowns.iter().map(|u| u.bounds[0] < u.bounds[1]).collect();
    Ok(Posterior {
        deviation: problem.deviation(&x)?,
        covariance: prior.covariance(inverse_symmetric(&curvature, &is_free)),
        gains: layout.gains(&x, series.weights.len()),
        layout,
        x,
    })
}

/// The information of each press of a series about the unknowns, at the learned values: matrices,
/// row by row, of which only the lower triangle counts; `[n_presses][n * n]`. Then the prior
/// information about each unknown; `[n]`.
pub(crate) fn information(
    elastic: &dyn Elastic,
    series: &Series,
    learned: &Gains,
    prior: Prior,
    left_out: &BTreeSet<usize>,
) -> Result<(Vec<Vec<f64>>, Vec<f64>), DigitacError> {
    let (layout, unknowns) = near_learned(elastic, series, learned, prior, left_out);
    let problem = Problem {
        elastic,
        series,
        left_out,
        layout: &layout,
    };
    let x: Vec<f64> = unknowns.iter().map(|unknown| unknown.start).collect();
    let n = x.len();
    let pressures = elastic.pressures(&x[..layout.n_elastic], true)?;
    let fadings = problem.fadings(learned);
    let mut matrices = vec![vec![0.0; n * n]; series.presses.len()];
    let kept = (0..series.weights.len()).filter(|k| !left_out.contains(k));
    for k in kept {
        let pass = problem.pass(k, &pressures.kpa[k], learned, &fadings);
        let columns = problem.columns(k, &pass, &pressures, &x, &fadings);
        for (matrix, press) in matrices.iter_mut().zip(&series.presses) {
            add_products(&columns, &series.weights[k], press, matrix, n);
        }
    }
    for matrix in &mut matrices {
        Prior::information(matrix, series.presses.len());
    }
    let known = unknowns.iter().map(|unknown| prior.known(unknown)).collect();
    Ok((matrices, known))
}

/// Layout and unknowns of a fit near learned values.
fn near_learned(
    elastic: &dyn Elastic,
    series: &Series,
    learned: &Gains,
    prior: Prior,
    left_out: &BTreeSet<usize>,
) -> (Layout, Vec<Unknown>) {
    let mut unknowns = elastic.unknowns();
    let largest_kpa = series.per_kpa.iter().filter(|p| **p > 0.0).map(|p| p.recip());
    let layout = Layout {
        n_elastic: unknowns.len(),
        n_constants: learned.time_constants_s.len(),
        largest_kpa: largest_kpa.fold(0.0, f64::max),
        usual_gain: usual_gain(learned, left_out),
    };
    let model = BarometerModel {
        time_constants_s: learned.time_constants_s.clone(),
        has_port_law: learned.stiffening_per_kpa.iter().any(|growth| *growth != 0.0),
    };
    let mut barometers = layout.unknowns(learned, &model);
    layout.pull(&mut barometers, prior);
    unknowns.extend(barometers);
    (layout, unknowns)
}

/// Nonnegative gains and overstress shares that fit best at the given time constants, by least
/// absolute deviations.
fn start_gains(pressures: &Pressures, series: &Series, time_constants_s: &[f64]) -> Gains {
    let all = 0..series.n_frames();
    let mut gains = Gains {
        gain: Vec::new(),
        stiffening_per_kpa: vec![0.0; pressures.kpa.len()],
        memory: Vec::new(),
        time_constants_s: time_constants_s.to_vec(),
    };
    let fadings: Vec<Fading> = time_constants_s
        .iter()
        .map(|tau| Fading::new(&series.since_s, *tau))
        .collect();
    for (k, pressure) in pressures.kpa.iter().enumerate() {
        let used: Vec<usize> = (0..series.n_frames())
            .filter(|i| series.weights[k][*i] > 0.0)
            .collect();
        let pick = |mut values: Vec<f64>| -> Vec<f64> {
            series.set_to_zero(&all, &mut values);
            used.iter().map(|&i| values[i] * series.per_kpa[i]).collect()
        };
        let mut columns = vec![pick(pressure.clone())];
        columns.extend(fadings.iter().map(|fading| pick(fading.follow(&all, pressure))));
        let target: Vec<f64> = used
            .iter()
            .map(|&i| series.readings_kpa[k][i] * series.per_kpa[i])
            .collect();
        let (fit, _) = fit_nonnegative(&columns, &target);
        gains.gain.push(fit[0]);
        let share = |a: &f64| if fit[0] > 0.0 { a / fit[0] } else { 0.0 };
        gains.memory.push(fit[1..].iter().map(share).collect());
    }
    gains
}

/// Geometric mean of the gains of all taxels that are not excluded.
fn usual_gain(gains: &Gains, left_out: &BTreeSet<usize>) -> f64 {
    let kept = || {
        gains
            .gain
            .iter()
            .enumerate()
            .filter(|(k, gain)| !left_out.contains(k) && **gain > 0.0)
    };
    let sum: f64 = kept().map(|(_, gain)| gain.ln()).sum();
    (sum / kept().count().max(1) as f64).exp()
}

/// The relaxation with one time constant over all frames.
struct Fading {
    /// The remaining share of the old overstress and the share of a change that becomes overstress,
    /// with their derivatives with respect to ln time constant; `[n_frames]`.
    shares: Vec<[f64; 4]>,
}

impl Fading {
    fn new(since_s: &[Option<f64>], time_constant_s: f64) -> Self {
        let shares = since_s.iter().map(|since_s| {
            since_s.map_or([0.0; 4], |since_s| {
                let (kept, arrived) = overstress_step(since_s, time_constant_s);
                [kept, arrived, kept * since_s / time_constant_s, arrived - kept]
            })
        });
        Self {
            shares: shares.collect(),
        }
    }

    /// The overstress that follows `values`, which belong to the frames of `range`; there is none
    /// before.
    fn follow(&self, range: &Range<usize>, values: &[f64]) -> Vec<f64> {
        let mut q = vec![0.0; values.len()];
        for (i, [kept, arrived, ..]) in self.shares[range.clone()].iter().enumerate().skip(1) {
            q[i] = kept * q[i - 1] + arrived * (values[i] - values[i - 1]);
        }
        q
    }

    /// Derivative, with respect to ln time constant, of an overstress that follows `values`.
    fn slope(&self, values: &[f64], q: &[f64]) -> Vec<f64> {
        let mut slope = vec![0.0; values.len()];
        for (i, [kept, _, kept_slope, arrived_slope]) in self.shares.iter().enumerate().skip(1) {
            slope[i] =
                kept * slope[i - 1] + kept_slope * q[i - 1] + arrived_slope * (values[i] - values[i - 1]);
        }
        slope
    }
}

/// Adds the shares of all overstresses that follow `values`, which belong to the frames of `range`;
/// there are none before.
fn add_overstresses(fadings: &[Fading], shares: &[f64], range: &Range<usize>, values: &mut [f64]) {
    let mut overstresses = vec![0.0; fadings.len()];
    let mut before = values.first().copied().unwrap_or(0.0);
    for (value, frame) in values.iter_mut().zip(range.clone()).skip(1) {
        let change = *value - before;
        before = *value;
        for ((q, fading), share) in overstresses.iter_mut().zip(fadings).zip(shares) {
            let [kept, arrived, ..] = fading.shares[frame];
            *q = kept * *q + arrived * change;
            *value += share * *q;
        }
    }
}

struct Problem<'a> {
    elastic: &'a dyn Elastic,
    series: &'a Series,
    left_out: &'a BTreeSet<usize>,
    layout: &'a Layout,
}

/// The readings of one taxel, and the quantities that they are computed from.
struct TaxelPass {
    elastic_kpa: Vec<f64>,
    overstress_kpa: Vec<Vec<f64>>,
    relaxed_kpa: Vec<f64>,
    /// Deviations over the largest reading of the installation; `[n_frames]`.
    deviations: Vec<f64>,
}

impl Problem<'_> {
    fn fadings(&self, gains: &Gains) -> Vec<Fading> {
        let constants = gains.time_constants_s.iter();
        constants
            .map(|tau| Fading::new(&self.series.since_s, *tau))
            .collect()
    }

    fn pass(&self, k: usize, pressure_kpa: &[f64], gains: &Gains, fadings: &[Fading]) -> TaxelPass {
        let all = 0..pressure_kpa.len();
        let elastic_kpa: Vec<f64> = pressure_kpa.iter().map(|p| gains.gain[k] * p).collect();
        let stiffening = gains.stiffening_per_kpa[k];
        let relaxed_kpa: Vec<f64> = elastic_kpa.iter().map(|e| port_reading(stiffening, *e)).collect();
        let overstress_kpa: Vec<Vec<f64>> = fadings
            .iter()
            .map(|fading| fading.follow(&all, &relaxed_kpa))
            .collect();
        let mut readings = relaxed_kpa.clone();
        for (share, q) in gains.memory[k].iter().zip(&overstress_kpa) {
            readings
                .iter_mut()
                .zip(q)
                .for_each(|(reading, q)| *reading += share * q);
        }
        self.series.set_to_zero(&all, &mut readings);
        let measured = self.series.readings_kpa[k].iter().zip(&self.series.per_kpa);
        TaxelPass {
            deviations: readings
                .iter()
                .zip(measured)
                .map(|(r, (m, per_kpa))| (r - m) * per_kpa)
                .collect(),
            elastic_kpa,
            overstress_kpa,
            relaxed_kpa,
        }
    }

    fn cost(&self, x: &[f64]) -> Result<f64, DigitacError> {
        self.sum(x, &|deviation| deviation.hypot(CORNER) - CORNER, true)
    }

    /// Weighted mean of the absolute deviations of all taxels that are not excluded.
    fn deviation(&self, x: &[f64]) -> Result<f64, DigitacError> {
        self.sum(x, &|deviation| deviation.abs(), false)
    }

    fn sum(&self, x: &[f64], penalty: &dyn Fn(f64) -> f64, all_taxels: bool) -> Result<f64, DigitacError> {
        let pressures = self.elastic.pressures(&x[..self.layout.n_elastic], false)?;
        let gains = self.layout.gains(x, pressures.kpa.len());
        let fadings = self.fadings(&gains);
        let taxels = pressures.kpa.iter().enumerate();
        let counted = taxels.filter(|(k, _)| all_taxels || !self.left_out.contains(k));
        Ok(counted
            .map(|(k, kpa)| {
                let pass = self.pass(k, kpa, &gains, &fadings);
                let weighted = pass.deviations.iter().zip(&self.series.weights[k]);
                weighted
                    .map(|(deviation, weight)| weight * penalty(*deviation))
                    .sum::<f64>()
            })
            .sum())
    }

    fn near(&self, x: &[f64]) -> Result<Quadratic, DigitacError> {
        let n = x.len();
        let pressures = self.elastic.pressures(&x[..self.layout.n_elastic], true)?;
        let gains = self.layout.gains(x, pressures.kpa.len());
        let fadings = self.fadings(&gains);
        let mut quadratic = Quadratic {
            gradient: vec![0.0; n],
            matrix: vec![0.0; n * n],
        };
        for (k, kpa) in pressures.kpa.iter().enumerate() {
            let pass = self.pass(k, kpa, &gains, &fadings);
            let columns = self.columns(k, &pass, &pressures, x, &fadings);
            self.add(k, &pass, &columns, &mut quadratic);
        }
        Ok(quadratic)
    }

    /// Derivatives of a taxel's deviations.
    fn columns(
        &self,
        k: usize,
        pass: &TaxelPass,
        pressures: &Pressures,
        x: &[f64],
        fadings: &[Fading],
    ) -> Vec<Column> {
        let gains = &self.layout.gains(x, pressures.kpa.len());
        let all = 0..pass.relaxed_kpa.len();
        let law: Vec<[f64; 2]> = pass
            .elastic_kpa
            .iter()
            .map(|e| port_slopes(gains.stiffening_per_kpa[k], *e))
            .collect();
        // Effect of relaxation and of the zero on a change of the relaxed reading.
        let remember = |unknown: usize, frames: Range<usize>, mut values: Vec<f64>| {
            add_overstresses(fadings, &gains.memory[k], &frames, &mut values);
            self.column(unknown, frames, values)
        };
        let own = self.layout.of_taxel(k);
        // Effect of a unit of the common growth on the nonlinearity of this taxel; it is inversely
        // proportional to the taxel's gain.
        let share = self.layout.usual_gain / gains.gain[k] / self.layout.largest_kpa;
        let falls = share * x[self.layout.common()];
        let of_gain = law
            .iter()
            .zip(&pass.elastic_kpa)
            .map(|([slope, by_law], e)| slope * e - by_law * falls);
        let of_stiffening = law.iter().map(|[_, slope]| slope / self.layout.largest_kpa);
        let of_gain = remember(own, all.clone(), of_gain.collect());
        let of_common_gain = Column {
            unknown: self.layout.common() + 1,
            ..of_gain.clone()
        };
        let mut columns = vec![of_gain, remember(own + 1, all.clone(), of_stiffening.collect())];
        for (j, q) in pass.overstress_kpa.iter().enumerate() {
            columns.push(self.column(own + 2 + j, all.clone(), q.clone()));
        }
        if self.left_out.contains(&k) {
            return columns;
        }
        columns.push(of_common_gain);
        let of_common = law.iter().map(|[_, slope]| share * slope);
        columns.push(remember(self.layout.common(), all.clone(), of_common.collect()));
        for (j, (fading, q)) in fadings.iter().zip(&pass.overstress_kpa).enumerate() {
            let share = gains.memory[k][j];
            let slope = fading.slope(&pass.relaxed_kpa, q).into_iter().map(|s| share * s);
            columns.push(self.column(self.layout.n_elastic + j, all.clone(), slope.collect()));
        }
        for slope in &pressures.slopes {
            let kpa = match slope.taxel {
                None => &slope.kpa[k],
                Some(taxel) if taxel == k => &slope.kpa[0],
                Some(_) => continue,
            };
            let law = &law[slope.frames.clone()];
            let values = kpa
                .iter()
                .zip(law)
                .map(|(p, [by_elastic, _])| by_elastic * gains.gain[k] * p);
            columns.push(remember(slope.unknown, slope.frames.clone(), values.collect()));
        }
        columns
    }

    fn column(&self, unknown: usize, frames: Range<usize>, mut values: Vec<f64>) -> Column {
        self.series.set_to_zero(&frames, &mut values);
        let per_kpa = &self.series.per_kpa[frames.clone()];
        values
            .iter_mut()
            .zip(per_kpa)
            .for_each(|(value, per_kpa)| *value *= per_kpa);
        Column {
            unknown,
            frames,
            values,
        }
    }

    fn add(&self, k: usize, pass: &TaxelPass, columns: &[Column], quadratic: &mut Quadratic) {
        let n = quadratic.gradient.len();
        let weights: Vec<f64> = pass
            .deviations
            .iter()
            .zip(&self.series.weights[k])
            .map(|(deviation, weight)| weight / deviation.hypot(CORNER))
            .collect();
        for (a, column) in columns.iter().enumerate() {
            let weighted: Vec<f64> = column
                .values
                .iter()
                .zip(&weights[column.frames.clone()])
                .map(|(value, weight)| value * weight)
                .collect();
            let slopes = weighted.iter().zip(&pass.deviations[column.frames.clone()]);
            quadratic.gradient[column.unknown] += slopes.map(|(w, deviation)| w * deviation).sum::<f64>();
            for other in &columns[..=a] {
                let common =
                    column.frames.start.max(other.frames.start)..column.frames.end.min(other.frames.end);
                if common.is_empty() {
                    continue;
                }
                let part = |frames: &Range<usize>| common.start - frames.start..common.end - frames.start;
                let sum = dot(
                    &weighted[part(&column.frames)],
                    &other.values[part(&other.frames)],
                );
                let (i, j) = (
                    column.unknown.max(other.unknown),
                    column.unknown.min(other.unknown),
                );
                quadratic.matrix[i * n + j] += sum;
            }
        }
    }
}

/// Adds the weighted products of columns over some frames to a matrix.
fn add_products(columns: &[Column], weights: &[f64], frames: &Range<usize>, matrix: &mut [f64], n: usize) {
    for (a, column) in columns.iter().enumerate() {
        for other in &columns[..=a] {
            let start = frames.start.max(column.frames.start).max(other.frames.start);
            let end = frames.end.min(column.frames.end).min(other.frames.end);
            let value = |column: &Column, frame: usize| column.values[frame - column.frames.start];
            let sum: f64 = (start..end)
                .map(|frame| weights[frame] * value(column, frame) * value(other, frame))
                .sum();
            let (i, j) = (
                column.unknown.max(other.unknown),
                column.unknown.min(other.unknown),
            );
            matrix[i * n + j] += sum;
        }
    }
}

/// Derivative of a taxel's deviations with respect to one unknown, over some frames; zero
/// elsewhere.
#[derive(Clone)]
struct Column {
    unknown: usize,
    frames: Range<usize>,
    values: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Features;
    use crate::features::zero_frames;
    use crate::physical_fit::{Fitted, Slope};

    /// Two presses that follow each other within a second, each down, held and up, and one after a
    /// rest; two taxels.
    fn presses() -> Vec<Features> {
        let press = |start_s: f64, deepest_mm: f64, since_previous_s: Option<f64>| {
            let time_s: Vec<f64> = (0..120).map(|i| start_s + 0.06 * f64::from(i)).collect();
            let way_mm = |t: f64| (t - 1.2).min(deepest_mm).min(6.0 - t).max(-0.8);
            let depth_mm: Vec<f64> = time_s.iter().map(|t| way_mm(t - start_s)).collect();
            let pressure =
                |depth_mm: &f64| vec![depth_mm.max(0.0).powf(1.6), 0.4 * depth_mm.max(0.0).powf(1.4)];
            Features {
                force_n: vec![0.0; time_s.len()],
                pressure_kpa: depth_mm.iter().map(pressure).collect(),
                stress_kpa_per_mm: vec![vec![0.0; 2]; time_s.len()],
                simulated: vec![true; time_s.len()],
                since_previous_s,
                zero_frames: zero_frames(&time_s, &depth_mm),
                time_s,
                depth_mm,
            }
        };
        vec![
            press(0.0, 1.5, None),
            press(7.5, 1.0, Some(0.36)),
            press(0.0, 2.0, None),
        ]
    }

    fn truth() -> Gains {
        Gains {
            gain: vec![0.8, 1.3],
            stiffening_per_kpa: vec![0.15, -0.1],
            memory: vec![vec![0.3, 0.1], vec![0.2, 0.25]],
            time_constants_s: vec![0.4, 5.0],
        }
    }

    fn series(presses: &[Features], readings_kpa: &[Vec<Vec<f64>>], valid: &[Vec<bool>]) -> Series {
        let fitted: Vec<Fitted<'_>> = presses
            .iter()
            .zip(readings_kpa)
            .map(|(features, readings_kpa)| Fitted {
                mounting: "file",
                features,
                readings_kpa,
                valid,
                is_used: true,
            })
            .collect();
        Series::new(&fitted, 2, &BTreeSet::new())
    }

    /// Pressures that are scaled by an unknown share.
    struct Scaled {
        kpa: Vec<Vec<f64>>,
    }

    impl Elastic for Scaled {
        fn unknowns(&self) -> Vec<Unknown> {
            vec![Unknown {
                start: 0.1,
                bounds: [-0.5, 0.5],
                center: 0.0,
                pull: 0.0,
            }]
        }

        fn pressures(&self, values: &[f64], _with_slopes: bool) -> Result<Pressures, DigitacError> {
            let scaled = |by: f64| {
                self.kpa
                    .iter()
                    .map(|row| row.iter().map(|p| by * p).collect())
                    .collect()
            };
            Ok(Pressures {
                kpa: scaled(1.0 + values[0]),
                slopes: vec![Slope {
                    unknown: 0,
                    taxel: None,
                    frames: 0..self.kpa[0].len(),
                    kpa: scaled(1.0),
                }],
            })
        }
    }

    fn kpa(presses: &[Features]) -> Vec<Vec<f64>> {
        let rows = || presses.iter().flat_map(|press| &press.pressure_kpa);
        (0..2).map(|k| rows().map(|row| row[k]).collect()).collect()
    }

    #[test]
    fn barometers_are_recovered_from_what_they_read_along_presses_that_follow_each_other() {
        let presses = presses();
        let readings_kpa = truth().readings_kpa(&presses.iter().collect::<Vec<_>>());
        let valid = vec![vec![true; 2]; 120];
        let series = series(&presses, &readings_kpa, &valid);
        let model = BarometerModel {
            time_constants_s: vec![0.25, 4.0],
            has_port_law: true,
        };
        let known = crate::physical_fit::Known { kpa: kpa(&presses) };
        let found = fit(&known, &series, &model, &BTreeSet::new(), None).unwrap();
        assert!(found.deviation < 1e-3, "{} {:?}", found.deviation, found.gains);
        let near = |found: &[f64], expected: &[f64]| {
            let pairs = found.iter().zip(expected);
            pairs.fold(0.0_f64, |most, (f, e)| most.max((f - e).abs()))
        };
        assert!(near(&found.gains.gain, &truth().gain) < 0.02, "{:?}", found.gains);
        let stiffening = near(&found.gains.stiffening_per_kpa, &truth().stiffening_per_kpa);
        assert!(stiffening < 0.02, "{:?}", found.gains);
    }

    #[test]
    fn slopes_of_the_cost_are_quotients_of_differences() {
        let presses = presses();
        let readings_kpa = truth().readings_kpa(&presses.iter().collect::<Vec<_>>());
        let valid = vec![vec![true; 2]; 120];
        let series = series(&presses, &readings_kpa, &valid);
        let layout = Layout {
            n_elastic: 1,
            n_constants: 2,
            largest_kpa: 4.0,
            usual_gain: 0.8,
        };
        let problem = Problem {
            elastic: &Scaled { kpa: kpa(&presses) },
            series: &series,
            left_out: &BTreeSet::new(),
            layout: &layout,
        };
        let x = [
            0.1, -1.2, 1.5, 0.4, 0.05, -0.1, 0.3, 0.2, 0.3, 0.4, -0.2, 0.1, 0.2,
        ];
        let gradient = problem.near(&x).unwrap().gradient;
        for (i, slope) in gradient.iter().enumerate() {
            let moved = |by: f64| {
                let mut x = x;
                x[i] += by;
                problem.cost(&x).unwrap()
            };
            let quotient = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            assert!(
                (slope - quotient).abs() < 1e-5 + 1e-3 * quotient.abs(),
                "{i}: {slope}, quotient {quotient}"
            );
        }
    }
}
