//! Nonlinear least squares within bounds: Levenberg (1944) and Marquardt (1963), steps scaled by the diagonal of the normal matrix.

use faer::linalg::solvers::Solve;
use faer::{ColMut, Mat, Side};

use crate::CalibrateError;
use crate::problem::{Evaluation, Problem};

/// The search ends when a step promises to lower the sum of squares by less than this fraction of the residuals' variance: about a
/// hundredth of a standard error.
const ENOUGH: f64 = 1e-4;

/// Mean square of the residuals below which the fit counts as exact.
const EXACT: f64 = 1e-16;

/// Damping at first, and the largest that is tried.
const DAMPING: [f64; 2] = [1e-4, 1e8];

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
    'steps: while iterations < max_iterations {
        let cost = squares(&evaluation);
        let variance = cost / evaluation.residuals.len() as f64;
        let (matrix, gradient) = normal_equations(&evaluation, n);
        // What stands at its bound and would leave it stays there.
        let is_held = |i: usize| {
            let [low, high] = unknowns[i].bounds;
            x[i] <= low && gradient[i] > 0.0 || x[i] >= high && gradient[i] < 0.0
        };
        let moving: Vec<usize> = (0..n).filter(|&i| !is_held(i) && matrix[(i, i)] > 0.0).collect();
        loop {
            let damped = Mat::from_fn(moving.len(), moving.len(), |i, j| {
                matrix[(moving[i], moving[j])] * if i == j { 1.0 + damping } else { 1.0 }
            });
            let right: Vec<f64> = moving.iter().map(|&i| -gradient[i]).collect();
            if let Ok(factors) = damped.llt(Side::Lower) {
                let mut step = right.clone();
                factors.solve_in_place(ColMut::from_slice_mut(&mut step));
                let promised: f64 = (0..moving.len())
                    .map(|k| step[k] * (right[k] + damping * matrix[(moving[k], moving[k])] * step[k]))
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
                eprintln!("SCR it {iterations} cost {cost:.6e} promised {promised:.3e} damping {damping:.1e} shorter {shorter:.3} trial {:?}", &trial[..4]);
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
