//! Nonlinear least squares within bounds: Levenberg (1944) and Marquardt (1963), steps scaled by the diagonal of the normal matrix.

use crate::CalibrateError;
use crate::matrix::{Square, solve};
use crate::problem::{Evaluation, Problem};

/// A step that promises to lower the sum of squares by less than this part of the residuals' variance is not worth a press: it is a
/// hundredth of a standard error.
const ENOUGH: f64 = 1e-4;

/// Sum of squares a residual below which there is nothing left to fit.
const EXACT: f64 = 1e-16;

/// Damping at first, and the largest that is tried.
const DAMPING: [f64; 2] = [1e-4, 1e8];

/// Where a search ended.
pub(crate) struct Solution {
    pub(crate) x: Vec<f64>,
    pub(crate) evaluation: Evaluation,
    pub(crate) iterations: u32,
    /// Whether no further step promised anything.
    pub(crate) converged: bool,
}

/// `JᵀJ` and `Jᵀr`.
pub(crate) fn normal_equations(evaluation: &Evaluation, n: usize) -> (Square, Vec<f64>) {
    let (mut matrix, mut gradient) = (vec![vec![0.0; n]; n], vec![0.0; n]);
    for (row, residual) in evaluation.jacobian.iter().zip(&evaluation.residuals) {
        for i in 0..n {
            gradient[i] += row[i] * residual;
            for j in 0..n {
                matrix[i][j] += row[i] * row[j];
            }
        }
    }
    (matrix, gradient)
}

fn squares(evaluation: &Evaluation) -> f64 {
    evaluation.residuals.iter().map(|r| r * r).sum()
}

/// Goes downhill from `x`; `tell` hears the root mean square of the residuals after each step. A guess that can't be simulated counts as a
/// worse one.
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
    'steps: while iterations < max_iterations {
        let cost = squares(&evaluation);
        let variance = cost / evaluation.residuals.len() as f64;
        let (matrix, gradient) = normal_equations(&evaluation, n);
        // What stands at its bound and would leave it stays there.
        let is_held = |i: usize| {
            let [low, high] = unknowns[i].bounds;
            x[i] <= low && gradient[i] > 0.0 || x[i] >= high && gradient[i] < 0.0
        };
        let moving: Vec<usize> = (0..n).filter(|&i| !is_held(i) && matrix[i][i] > 0.0).collect();
        loop {
            let damped: Square = moving
                .iter()
                .map(|&i| {
                    let entry = |j: usize| matrix[i][j] + if i == j { damping * matrix[i][i] } else { 0.0 };
                    moving.iter().map(|&j| entry(j)).collect()
                })
                .collect();
            let right: Vec<f64> = moving.iter().map(|&i| -gradient[i]).collect();
            if let Some(step) = solve(&damped, &right) {
                let promised: f64 = (0..moving.len())
                    .map(|k| step[k] * (right[k] + damping * matrix[moving[k]][moving[k]] * step[k]))
                    .sum();
                if moving.is_empty() || promised <= ENOUGH * variance || variance <= EXACT {
                    converged = true;
                    break 'steps;
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
                if let Ok(found) = found
                    && squares(&found) < cost
                {
                    x = trial;
                    evaluation = found;
                    damping = (0.1 * damping).max(1e-12);
                    tell((squares(&evaluation) / evaluation.residuals.len() as f64).sqrt());
                    continue 'steps;
                }
                tell((cost / evaluation.residuals.len() as f64).sqrt());
            }
            damping *= 10.0;
            if damping > DAMPING[1] || iterations >= max_iterations {
                break 'steps;
            }
        }
    }
    Solution {
        x,
        evaluation,
        iterations,
        converged,
    }
}
