//! Nonlinear least squares within bounds.
//!
//! With friction, derivatives are inexact, because friction is left out of some of them, and they
//! take twice as long as the curves. They are therefore not computed at each step; instead, the
//! result of a step corrects them along its direction (Broyden, Mathematics of Computation 19,
//! 1965). They are computed again after a rejected step for which they had promised an improvement,
//! and where the search would end.

use std::convert::Infallible;

use twintac_fit::{Method, Quadratic, Range};

use crate::CalibrateError;
use crate::problem::{Evaluation, Problem};

/// The search ends when a step promises to lower the sum of squares by less than this fraction of
/// one simulated frame's share of it: about a tenth of a standard error. Samples between frames are
/// interpolated, and carry no information of their own.
const ENOUGH: f64 = 1e-2;

/// The search also ends after this many successive steps that each lower the sum of squares by less
/// than that. With friction, the derivatives promise more than a step achieves.
const PATIENCE: u32 = 3;

/// Mean square of the residuals below which the fit counts as exact.
const EXACT: f64 = 1e-16;

/// The result of a search.
pub(crate) struct Solution {
    pub(crate) x: Vec<f64>,
    pub(crate) evaluation: Evaluation,
    /// The derivatives, computed at `x`.
    pub(crate) jacobian: Vec<Vec<f64>>,
    pub(crate) iterations: u32,
    /// Whether the search ended because no further step promised a smaller error.
    pub(crate) converged: bool,
}

/// `JᵀJ`, row by row, and `Jᵀr`.
pub(crate) fn normal_equations(jacobian: &[Vec<f64>], residuals: &[f64], n: usize) -> Quadratic {
    let (mut matrix, mut gradient) = (vec![0.0; n * n], vec![0.0; n]);
    for (row, residual) in jacobian.iter().zip(residuals) {
        for i in 0..n {
            gradient[i] += row[i] * residual;
            for j in 0..n {
                matrix[i * n + j] += row[i] * row[j];
            }
        }
    }
    Quadratic { gradient, matrix }
}

/// Half of the sum of squares.
fn cost(residuals: &[f64]) -> f64 {
    0.5 * residuals.iter().map(|r| r * r).sum::<f64>()
}

/// The derivatives of all residuals, `[n_residuals][n_unknowns]`, at one point.
struct Derivatives {
    rows: Vec<Vec<f64>>,
    /// Whether they were computed at this point, and not only corrected on the way to it.
    are_computed: bool,
    /// Whether rejected steps have corrected them at this point. After many short ones they contain
    /// the noise of the simulations, over the lengths of the steps.
    are_corrected: bool,
}

impl Derivatives {
    /// Changes the derivatives as little as possible, each measured in the unit of its column, so
    /// that they predict the residuals that were found at the end of a step.
    fn correct(&mut self, way: &[f64], before: &[f64], after: &[f64]) {
        let columns = (0..way.len()).map(|i| self.rows.iter().map(|row| row[i] * row[i]).sum::<f64>());
        let weighted: Vec<f64> = columns.zip(way).map(|(square, way)| square * way).collect();
        let length: f64 = weighted
            .iter()
            .zip(way)
            .map(|(weighted, way)| weighted * way)
            .sum();
        if length == 0.0 {
            return; // all unknowns are held by the bounds
        }
        for (row, (before, after)) in self.rows.iter_mut().zip(before.iter().zip(after)) {
            let foretold: f64 = row.iter().zip(way).map(|(rate, way)| rate * way).sum();
            for (rate, weighted) in row.iter_mut().zip(&weighted) {
                *rate += (after - before - foretold) * weighted / length;
            }
        }
    }
}

/// The sum of squares of a problem, and the point where it was lowest so far.
struct Squares<'a> {
    problem: &'a Problem<'a>,
    x: Vec<f64>,
    residuals: Vec<f64>,
    derivatives: Derivatives,
}

impl<'a> Squares<'a> {
    fn new(problem: &'a Problem<'a>, x: &[f64], at: &Evaluation) -> Result<Self, CalibrateError> {
        let derivatives = Derivatives {
            rows: problem.jacobian(x, at)?,
            are_computed: true,
            are_corrected: false,
        };
        Ok(Self {
            problem,
            x: x.to_owned(),
            residuals: at.residuals.clone(),
            derivatives,
        })
    }

    /// Computes the derivatives at the point where the sum was lowest. If that fails, the present
    /// ones are kept.
    fn compute(&mut self, at: &Evaluation) {
        if let Ok(rows) = self.problem.jacobian(&self.x, at) {
            self.derivatives.rows = rows;
            self.derivatives.are_corrected = false;
        }
        self.derivatives.are_computed = true;
    }

    fn way_to(&self, x: &[f64]) -> Vec<f64> {
        x.iter().zip(&self.x).map(|(to, from)| to - from).collect()
    }
}

impl twintac_fit::Problem for Squares<'_> {
    type At = Evaluation;
    type Error = Infallible;

    /// A point that cannot be simulated is rejected.
    fn evaluate(&mut self, x: &[f64]) -> Result<Option<(f64, Evaluation)>, Infallible> {
        let evaluation = self.problem.evaluate(x).ok();
        Ok(evaluation.map(|evaluation| (cost(&evaluation.residuals), evaluation)))
    }

    fn near(&mut self, x: &[f64], at: &Evaluation) -> Result<Quadratic, Infallible> {
        let way = self.way_to(x);
        if way.iter().any(|way| *way != 0.0) {
            self.derivatives.correct(&way, &self.residuals, &at.residuals);
            (self.derivatives.are_computed, self.derivatives.are_corrected) = (false, false);
            (self.x, self.residuals) = (x.to_owned(), at.residuals.clone());
            if at.has_rates {
                self.compute(at);
            }
        }
        Ok(normal_equations(&self.derivatives.rows, &self.residuals, x.len()))
    }

    fn rejected(&mut self, here: &mut Evaluation, way: &[f64], there: &Evaluation) -> bool {
        if !self.derivatives.are_computed {
            self.compute(here);
        }
        self.derivatives.correct(way, &self.residuals, &there.residuals);
        self.derivatives.are_corrected = true;
        true
    }
}

/// Minimizes the sum of squares from `x`. `tell` is called after each step with the root mean
/// square of the residuals.
///
/// # Errors
/// The derivatives cannot be computed at `x`.
pub(crate) fn minimize(
    problem: &Problem,
    x: Vec<f64>,
    evaluation: Evaluation,
    max_iterations: u32,
    tell: &mut dyn FnMut(f64),
) -> Result<Solution, CalibrateError> {
    let n_residuals = evaluation.residuals.len() as f64;
    let enough = ENOUGH / problem.n_frames() as f64;
    let ranges = problem.unknowns.all.iter().map(|unknown| Range {
        bounds: unknown.bounds,
        reach: unknown.reach,
    });
    let ranges: Vec<Range> = ranges.collect();
    let mut tell = |cost: f64| tell((2.0 * cost / n_residuals).sqrt());
    let mut squares = Squares::new(problem, &x, &evaluation)?;
    let (mut start, mut iterations) = ((x, cost(&evaluation.residuals), evaluation), 0);
    loop {
        let method = Method {
            damping: [1e-4, 1e-5, 1e8],
            factors: [0.1, 4.0],
            max_steps: max_iterations - iterations,
            enough_promised: enough,
            patience: (PATIENCE, enough),
            exact: 0.5 * n_residuals * EXACT,
        };
        let Ok(found) = twintac_fit::minimize(&mut squares, &ranges, start, &method, &mut tell);
        iterations += found.n_steps;
        let was_computed = squares.derivatives.are_computed;
        if !was_computed || squares.derivatives.are_corrected {
            squares.compute(&found.at);
        }
        if was_computed || !found.is_settled {
            return Ok(Solution {
                x: found.x,
                evaluation: found.at,
                jacobian: squares.derivatives.rows,
                iterations,
                converged: found.is_settled,
            });
        }
        start = (found.x, found.cost, found.at);
    }
}
