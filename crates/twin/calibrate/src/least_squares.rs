//! Nonlinear least squares within bounds: Levenberg (1944) and Marquardt (1963), steps scaled by the diagonal of the normal matrix.
//!
//! Derivatives of a rough contact are inexact: friction is left out of some of them. A step that they promise too much of is rejected, and corrects them
//! along its way (Broyden, Mathematics of Computation 19, 1965). Shorter steps alone would end the search where it was misled.

use faer::linalg::solvers::Solve;
use faer::{ColMut, Mat, Side};

use crate::CalibrateError;
use crate::problem::{Evaluation, Problem};

/// The search ends when a step promises to lower the sum of squares by less than this fraction of the residuals' variance: about a
/// hundredth of a standard error.
const ENOUGH: f64 = 1e-4;

/// Mean square of the residuals below which the fit counts as exact.
const EXACT: f64 = 1e-16;

/// Damping at first, after the first rejected step at least, and the largest that is tried.
const DAMPING: [f64; 3] = [1e-4, 1e-3, 1e8];

/// The result of a search.
pub(crate) struct Solution {
    pub(crate) x: Vec<f64>,
    pub(crate) evaluation: Evaluation,
    pub(crate) iterations: u32,
    /// Whether the search ended because no further step promised a smaller error.
    pub(crate) converged: bool,
}

/// `JᵀJ` and `Jᵀr`.
pub(crate) fn normal_equations(evaluation: &Evaluation, n: usize) -> (Mat<f64>, Vec<f64>) {
    let (mut matrix, mut gradient) = (Mat::zeros(n, n), vec![0.0; n]);
    for (row, residual) in evaluation.jacobian.iter().zip(&evaluation.residuals) {
        for i in 0..n {
            gradient[i] += row[i] * residual;
            for j in 0..n {
                matrix[(i, j)] += row[i] * row[j];
            }
        }
    }
    (matrix, gradient)
}

/// Changes derivatives as little as can be, lengths along each unknown weighted, so that they lead to what was found at the end of a way.
fn correct(evaluation: &mut Evaluation, found: &[f64], way: &[f64], weights: &[f64]) {
    let weighted: Vec<f64> = way
        .iter()
        .zip(weights)
        .map(|(way, weight)| way * weight)
        .collect();
    let length: f64 = weighted
        .iter()
        .zip(way)
        .map(|(weighted, way)| weighted * way)
        .sum();
    if length == 0.0 {
        return; // held by the bounds
    }
    let rows = evaluation.jacobian.iter_mut().zip(&evaluation.residuals);
    for ((row, before), found) in rows.zip(found) {
        let foretold: f64 = row.iter().zip(way).map(|(rate, way)| rate * way).sum();
        for (rate, weighted) in row.iter_mut().zip(&weighted) {
            *rate += (found - before - foretold) * weighted / length;
        }
    }
}

fn squares(evaluation: &Evaluation) -> f64 {
    evaluation.residuals.iter().map(|r| r * r).sum()
}

/// Minimizes the sum of squares from `x`; `tell` is called with the root mean square of the residuals after each step. A trial that can't be
/// simulated counts as worse.
pub(crate) fn minimize(
    problem: &Problem,
    mut x: Vec<f64>,
    mut evaluation: Evaluation,
    max_iterations: u32,
    tell: &mut dyn FnMut(f64),
) -> Solution {
    let unknowns = &problem.unknowns.all;
    let n = unknowns.len();
    let mut damping = DAMPING[0];
    let mut iterations = 0;
    let mut converged = false;
    while iterations < max_iterations && damping <= DAMPING[2] {
        let cost = squares(&evaluation);
        let variance = cost / evaluation.residuals.len() as f64;
        let (matrix, gradient) = normal_equations(&evaluation, n);
        // What stands at its bound and would leave it stays there.
        let is_held = |i: usize| {
            let [low, high] = unknowns[i].bounds;
            x[i] <= low && gradient[i] > 0.0 || x[i] >= high && gradient[i] < 0.0
        };
        let moving: Vec<usize> = (0..n).filter(|&i| !is_held(i) && matrix[(i, i)] > 0.0).collect();
        let damped = Mat::from_fn(moving.len(), moving.len(), |i, j| {
            matrix[(moving[i], moving[j])] * if i == j { 1.0 + damping } else { 1.0 }
        });
        let right: Vec<f64> = moving.iter().map(|&i| -gradient[i]).collect();
        let Ok(factors) = damped.llt(Side::Lower) else {
            damping *= 10.0;
            continue;
        };
        let mut step = right.clone();
        factors.solve_in_place(ColMut::from_slice_mut(&mut step));
        let promised: f64 = (0..moving.len())
            .map(|k| step[k] * (right[k] + damping * matrix[(moving[k], moving[k])] * step[k]))
            .sum();
        if moving.is_empty() || promised <= ENOUGH * variance || variance <= EXACT {
            converged = true;
            break;
        }
        let mut shorter: f64 = 1.0;
        for (&i, step) in moving.iter().zip(&step) {
            shorter = shorter.min(unknowns[i].reach / step.abs());
        }
        let mut trial = x.clone();
        for (&i, step) in moving.iter().zip(&step) {
            let [low, high] = unknowns[i].bounds;
            trial[i] = (x[i] + shorter * step).clamp(low, high);
        }
        iterations += 1;
        let found: Result<Evaluation, CalibrateError> = problem.evaluate(&trial);
        match found {
            Ok(found) if squares(&found) < cost => {
                x = trial;
                evaluation = found;
                damping = (0.1 * damping).max(1e-12);
            }
            Ok(found) => {
                let way: Vec<f64> = trial.iter().zip(&x).map(|(trial, x)| trial - x).collect();
                let weights: Vec<f64> = (0..n).map(|i| matrix[(i, i)]).collect();
                correct(&mut evaluation, &found.residuals, &way, &weights);
                damping = (2.0 * damping).max(DAMPING[1]);
            }
            Err(_) => damping = (10.0 * damping).max(DAMPING[1]),
        }
        tell((squares(&evaluation) / evaluation.residuals.len() as f64).sqrt());
    }
    Solution {
        x,
        evaluation,
        iterations,
        converged,
    }
}
