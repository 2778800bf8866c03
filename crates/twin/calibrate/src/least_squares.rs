//! Nonlinear least squares within bounds.
//!
//! Derivatives of a rough contact are inexact: friction is left out of some of them. A step that they promise too much of is rejected, and corrects them
//! along its way (Broyden, Mathematics of Computation 19, 1965). Shorter steps alone would end the search where it was misled.

use std::convert::Infallible;

use twintac_fit::{Method, Quadratic, Range};

use crate::problem::{Evaluation, Problem};

/// The search ends when a step promises to lower the sum of squares by less than this fraction of the residuals' variance: about a
/// hundredth of a standard error.
const ENOUGH: f64 = 1e-4;

/// Mean square of the residuals below which the fit counts as exact.
const EXACT: f64 = 1e-16;

/// The result of a search.
pub(crate) struct Solution {
    pub(crate) x: Vec<f64>,
    pub(crate) evaluation: Evaluation,
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
fn cost(evaluation: &Evaluation) -> f64 {
    0.5 * evaluation.residuals.iter().map(|r| r * r).sum::<f64>()
}

/// All curves at one guess, and their derivatives, corrected by steps that were rejected.
struct Corrected {
    evaluation: Evaluation,
    jacobian: Vec<Vec<f64>>,
}

impl Corrected {
    fn of(evaluation: Evaluation) -> Self {
        Self {
            jacobian: evaluation.jacobian.clone(),
            evaluation,
        }
    }
}

/// The sum of squares of a problem.
struct Squares<'a>(&'a Problem<'a>);

impl twintac_fit::Problem for Squares<'_> {
    type At = Corrected;
    type Error = Infallible;

    /// What can't be simulated is no place to go.
    fn evaluate(&mut self, x: &[f64]) -> Result<Option<(f64, Corrected)>, Infallible> {
        let found = self.0.evaluate(x).ok();
        Ok(found.map(|evaluation| (cost(&evaluation), Corrected::of(evaluation))))
    }

    fn near(&mut self, x: &[f64], at: &Corrected) -> Result<Quadratic, Infallible> {
        Ok(normal_equations(&at.jacobian, &at.evaluation.residuals, x.len()))
    }

    /// Changes derivatives as little as can be, each in the unit of its column, so that they lead to what was found at the end of the way.
    fn rejected(&mut self, here: &mut Corrected, way: &[f64], there: &Corrected) -> bool {
        let columns = (0..way.len()).map(|i| here.jacobian.iter().map(|row| row[i] * row[i]).sum::<f64>());
        let weighted: Vec<f64> = columns.zip(way).map(|(square, way)| square * way).collect();
        let length: f64 = weighted
            .iter()
            .zip(way)
            .map(|(weighted, way)| weighted * way)
            .sum();
        if length == 0.0 {
            return false; // held by the bounds
        }
        let ends = here.evaluation.residuals.iter().zip(&there.evaluation.residuals);
        for (row, (before, after)) in here.jacobian.iter_mut().zip(ends) {
            let foretold: f64 = row.iter().zip(way).map(|(rate, way)| rate * way).sum();
            for (rate, weighted) in row.iter_mut().zip(&weighted) {
                *rate += (after - before - foretold) * weighted / length;
            }
        }
        true
    }
}

/// Minimizes the sum of squares from `x`; `tell` is called with the root mean square of the residuals after each step.
pub(crate) fn minimize(
    problem: &Problem,
    x: Vec<f64>,
    evaluation: Evaluation,
    max_iterations: u32,
    tell: &mut dyn FnMut(f64),
) -> Solution {
    let n_residuals = evaluation.residuals.len() as f64;
    let method = Method {
        damping: [1e-4, 1e-5, 1e8],
        factors: [0.1, 4.0],
        max_steps: max_iterations,
        enough_promised: ENOUGH / n_residuals,
        patience: (u32::MAX, 0.0),
        exact: 0.5 * n_residuals * EXACT,
    };
    let ranges = problem.unknowns.all.iter().map(|unknown| Range {
        bounds: unknown.bounds,
        reach: unknown.reach,
    });
    let ranges: Vec<Range> = ranges.collect();
    let mut tell = |cost: f64| tell((2.0 * cost / n_residuals).sqrt());
    let start = (x, cost(&evaluation), Corrected::of(evaluation));
    let Ok(found) = twintac_fit::minimize(&mut Squares(problem), &ranges, start, &method, &mut tell);
    Solution {
        x: found.x,
        evaluation: found.at.evaluation,
        iterations: found.n_steps,
        converged: found.is_settled,
    }
}
