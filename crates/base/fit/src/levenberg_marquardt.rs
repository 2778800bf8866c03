//! Minimization within bounds: Levenberg (1944) and Marquardt (1963), steps damped by the diagonal of the Gauss-Newton matrix.

use crate::Triangle;

/// Where an unknown may be.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Smallest and largest value.
    pub bounds: [f64; 2],
    /// Largest change in one step.
    pub reach: f64,
}

/// A cost near a point: gradient, and Gauss-Newton matrix, of which only the lower triangle is read; `[n * n]`.
#[derive(Clone, Debug)]
pub struct Quadratic {
    /// Slope of the cost along each unknown.
    pub gradient: Vec<f64>,
    /// How the slopes change.
    pub matrix: Vec<f64>,
}

/// A cost, and where it was evaluated.
pub trait Problem {
    /// What an evaluation leaves for others.
    type At;
    /// Why a cost can't be had at all.
    type Error;

    /// The cost at a point, and what else is known there; nothing where the point can't be.
    ///
    /// # Errors
    /// The search ends with it.
    fn evaluate(&mut self, x: &[f64]) -> Result<Option<(f64, Self::At)>, Self::Error>;

    /// The cost near a point that was evaluated.
    ///
    /// # Errors
    /// The search ends with it.
    fn near(&mut self, x: &[f64], at: &Self::At) -> Result<Quadratic, Self::Error>;

    /// A step away from `here` was evaluated and rejected. Whether what is known `here` was corrected by it: then it is asked for again.
    fn rejected(&mut self, here: &mut Self::At, way: &[f64], there: &Self::At) -> bool {
        let _ = (here, way, there);
        false
    }
}

/// How a search goes, and when it ends.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// Damping at first, at least and at most.
    pub damping: [f64; 3],
    /// By what damping is multiplied after a step that lowers the cost, and after one that does not.
    pub factors: [f64; 2],
    /// Steps at most, rejected ones included.
    pub max_steps: u32,
    /// The search ends when a step promises to lower the cost by less than this fraction.
    pub enough_promised: f64,
    /// The search ends after so many steps in turn, each of which lowers the cost by less than this fraction.
    pub patience: (u32, f64),
    /// A cost that is small enough.
    pub exact: f64,
}

/// What a search ended with.
#[derive(Clone, Debug)]
pub struct Found<A> {
    /// The point with the smallest cost.
    pub x: Vec<f64>,
    /// The cost.
    pub cost: f64,
    /// What else is known there.
    pub at: A,
    /// Steps, rejected ones included.
    pub n_steps: u32,
    /// Whether the search ended because there was nothing more to gain.
    pub is_settled: bool,
}

/// Minimizes a cost from a point that was evaluated. `tell` hears the cost after each step.
///
/// # Errors
/// Those of the problem.
pub fn minimize<P: Problem>(
    problem: &mut P,
    ranges: &[Range],
    (mut x, mut cost, mut at): (Vec<f64>, f64, P::At),
    method: &Method,
    tell: &mut dyn FnMut(f64),
) -> Result<Found<P::At>, P::Error> {
    let n = ranges.len();
    let [mut damping, least, most] = method.damping;
    let [relax, damp] = method.factors;
    let (mut n_steps, mut is_settled, mut n_small) = (0, false, 0);
    let mut near = problem.near(&x, &at)?;
    while n_steps < method.max_steps && damping < most {
        let Quadratic { gradient, matrix } = &near;
        // What stands at its bound and would leave it stays there.
        let is_free = |i: usize| {
            let [low, high] = ranges[i].bounds;
            let leaves = x[i] <= low && gradient[i] > 0.0 || x[i] >= high && gradient[i] < 0.0;
            !leaves && matrix[i * n + i] > 0.0
        };
        let free: Vec<usize> = (0..n).filter(|&i| is_free(i)).collect();
        let mut damped = vec![0.0; free.len() * free.len()];
        for (a, &i) in free.iter().enumerate() {
            for (b, &j) in free[..=a].iter().enumerate() {
                let times = if a == b { 1.0 + damping } else { 1.0 };
                damped[a * free.len() + b] = times * matrix[i.max(j) * n + i.min(j)];
            }
        }
        let right: Vec<f64> = free.iter().map(|&i| -gradient[i]).collect();
        let step = Triangle::of(damped, free.len()).solve(right.clone());
        let gains = free.iter().zip(right.iter().zip(&step));
        let promised: f64 = gains
            .map(|(&i, (right, step))| 0.5 * step * (right + damping * matrix[i * n + i] * step))
            .sum();
        if free.is_empty() || promised <= method.enough_promised * cost || cost <= method.exact {
            is_settled = true;
            break;
        }
        let steps = free.iter().zip(&step);
        let shorter = steps.fold(1.0, |shorter: f64, (&i, step)| {
            shorter.min(ranges[i].reach / step.abs())
        });
        let mut trial = x.clone();
        for (&i, step) in free.iter().zip(&step) {
            let [low, high] = ranges[i].bounds;
            trial[i] = (x[i] + shorter * step).clamp(low, high);
        }
        n_steps += 1;
        match problem.evaluate(&trial)? {
            Some((found, there)) if found < cost => {
                n_small = if found < (1.0 - method.patience.1) * cost {
                    0
                } else {
                    n_small + 1
                };
                (x, cost, at) = (trial, found, there);
                damping = (relax * damping).max(least);
                tell(cost);
                if n_small >= method.patience.0 {
                    is_settled = true;
                    break;
                }
                near = problem.near(&x, &at)?;
            }
            rejected => {
                damping *= damp;
                tell(cost);
                if let Some((_, there)) = rejected {
                    let way: Vec<f64> = trial.iter().zip(&x).map(|(trial, x)| trial - x).collect();
                    if problem.rejected(&mut at, &way, &there) {
                        near = problem.near(&x, &at)?;
                    }
                }
            }
        }
    }
    Ok(Found {
        x,
        cost,
        at,
        n_steps,
        is_settled,
    })
}
