//! Minimization within bounds: Levenberg (1944) and Marquardt (1963), steps damped by the diagonal
//! of the Gauss-Newton matrix.

use crate::Triangle;

/// The search ends when even this fraction of a step leads to points where the cost cannot be
/// evaluated.
const LEAST_FRACTION: f64 = 1e-3;

/// Bounds of an unknown, and its largest step.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Smallest and largest value.
    pub bounds: [f64; 2],
    /// Largest change in one step.
    pub reach: f64,
}

/// Second-order model of a cost near a point: its gradient and its Gauss-Newton matrix, `[n * n]`,
/// of which only the lower triangle is read.
#[derive(Clone, Debug)]
pub struct Quadratic {
    /// Derivative of the cost along each unknown; `[n]`.
    pub gradient: Vec<f64>,
    /// Second derivatives (Gauss-Newton approximation), row by row; `[n * n]`.
    pub matrix: Vec<f64>,
}

/// A cost that can be evaluated at points.
pub trait Problem {
    /// What an evaluation computes beside the cost, for later use at the same point.
    type At;
    /// Why the cost cannot be evaluated at all.
    type Error;

    /// The cost at a point, and what else is known there; `None` if the point is not feasible.
    ///
    /// # Errors
    /// An error ends the search.
    fn evaluate(&mut self, x: &[f64]) -> Result<Option<(f64, Self::At)>, Self::Error>;

    /// The second-order model of the cost at a point that was evaluated.
    ///
    /// # Errors
    /// An error ends the search.
    fn near(&mut self, x: &[f64], at: &Self::At) -> Result<Quadratic, Self::Error>;

    /// Called when the trial point `there`, a step `way` from `here`, was rejected. Returns whether
    /// this corrected what is known at `here`; the second-order model is then computed again.
    fn rejected(&mut self, here: &mut Self::At, way: &[f64], there: &Self::At) -> bool {
        let _ = (here, way, there);
        false
    }
}

/// How a search proceeds, and when it ends.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// Initial, smallest and largest damping. The search ends at the largest.
    pub damping: [f64; 3],
    /// Factors by which the damping is multiplied: after a step that lowers the cost, and after one
    /// that does not.
    pub factors: [f64; 2],
    /// Largest number of steps, including rejected ones.
    pub max_steps: u32,
    /// The search ends when the predicted decrease of the cost is below this fraction of the cost.
    pub enough_promised: f64,
    /// The search ends after this number of successive steps that each lower the cost by less than
    /// this fraction.
    pub patience: (u32, f64),
    /// The search ends when the cost is not above this.
    pub exact: f64,
}

/// The result of a search.
#[derive(Clone, Debug)]
pub struct Found<A> {
    /// The point with the smallest cost.
    pub x: Vec<f64>,
    /// The cost.
    pub cost: f64,
    /// What else is known at this point.
    pub at: A,
    /// Number of steps, including rejected ones.
    pub n_steps: u32,
    /// Whether the search converged within the tolerances of [`Method`].
    pub is_settled: bool,
}

/// Minimizes a cost from a point that was evaluated: `(x, cost, what else is known there)`. Calls
/// `tell` with the cost after each step.
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
    let mut fraction = 1.0;
    let mut near = problem.near(&x, &at)?;
    while n_steps < method.max_steps && damping < most && fraction > LEAST_FRACTION {
        let Quadratic { gradient, matrix } = &near;
        // An unknown at a bound stays there if the cost falls towards the outside.
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
            trial[i] += fraction * ((x[i] + shorter * step).clamp(low, high) - x[i]);
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
                fraction = f64::min(2.0 * fraction, 1.0);
                tell(cost);
                if n_small >= method.patience.0 {
                    is_settled = true;
                    break;
                }
                near = problem.near(&x, &at)?;
            }
            Some((_, there)) => {
                damping *= damp;
                tell(cost);
                let way: Vec<f64> = trial.iter().zip(&x).map(|(trial, x)| trial - x).collect();
                if problem.rejected(&mut at, &way, &there) {
                    near = problem.near(&x, &at)?;
                }
            }
            // The cost is not known there, so half of the way is tried. More damping would turn the
            // step, but would shorten it only after many trials.
            None => {
                fraction *= 0.5;
                tell(cost);
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

#[cfg(test)]
mod tests {
    use super::*;

    const METHOD: Method = Method {
        damping: [1e-4, 1e-5, 1e8],
        factors: [0.1, 4.0],
        max_steps: 30,
        enough_promised: 1e-12,
        patience: (u32::MAX, 0.0),
        exact: 0.0,
    };

    /// `0.5 (ln(1 - x) - ln(1 - zero))²`: a Gauss-Newton step from 0 leads beyond 1, where the cost
    /// is not defined.
    struct UpToOne {
        zero: f64,
        n_beyond: u32,
    }

    impl UpToOne {
        fn residual(&self, x: f64) -> f64 {
            (1.0 - x).ln() - (1.0 - self.zero).ln()
        }
    }

    impl Problem for UpToOne {
        type At = ();
        type Error = std::convert::Infallible;

        fn evaluate(&mut self, x: &[f64]) -> Result<Option<(f64, ())>, Self::Error> {
            let can_be = x[0] < 1.0;
            self.n_beyond += u32::from(!can_be);
            Ok(can_be.then(|| (0.5 * self.residual(x[0]).powi(2), ())))
        }

        fn near(&mut self, x: &[f64], (): &()) -> Result<Quadratic, Self::Error> {
            let rate = -1.0 / (1.0 - x[0]);
            Ok(Quadratic {
                gradient: vec![rate * self.residual(x[0])],
                matrix: vec![rate * rate],
            })
        }
    }

    #[test]
    fn a_step_to_where_nothing_can_be_is_halved() {
        for (zero, bounds) in [(0.9, [-10.0, 10.0]), (0.99, [-10.0, 10.0]), (0.9, [-10.0, 1.0])] {
            let mut problem = UpToOne { zero, n_beyond: 0 };
            let range = Range { bounds, reach: 100.0 };
            let cost = 0.5 * problem.residual(0.0).powi(2);
            let start = (vec![0.0], cost, ());
            let Ok(found) = minimize(&mut problem, &[range], start, &METHOD, &mut |_| ());
            assert!(
                found.is_settled && (found.x[0] - zero).abs() < 1e-4,
                "{:?}",
                found.x
            );
            assert!(
                (1..9).contains(&problem.n_beyond),
                "{} of {}",
                problem.n_beyond,
                found.n_steps
            );
        }
    }

    #[test]
    fn a_search_ends_where_no_part_of_a_step_can_be() {
        struct Alone;
        impl Problem for Alone {
            type At = ();
            type Error = std::convert::Infallible;

            fn evaluate(&mut self, _: &[f64]) -> Result<Option<(f64, ())>, Self::Error> {
                Ok(None)
            }

            fn near(&mut self, x: &[f64], (): &()) -> Result<Quadratic, Self::Error> {
                Ok(Quadratic {
                    gradient: vec![x[0]],
                    matrix: vec![1.0],
                })
            }
        }
        let range = Range {
            bounds: [-10.0, 10.0],
            reach: 100.0,
        };
        let start = (vec![1.0], 0.5, ());
        let Ok(found) = minimize(&mut Alone, &[range], start, &METHOD, &mut |_| ());
        assert!(!found.is_settled && found.x == [1.0] && found.n_steps < 12);
    }
}
