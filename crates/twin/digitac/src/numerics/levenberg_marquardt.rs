//! Minimization of a sum of robust penalties within bounds, with the Gauss-Newton matrix of
//! reweighted residuals, and with regularization towards prior values.

use twintac_fit::{Method, Problem, Quadratic, Range, minimize};

/// Steps that lower the cost by less than a fraction of 1e-5 do not count as progress; three of
/// them end the search.
const METHOD: Method = Method {
    damping: [1e-3, 1e-9, 1e7],
    factors: [0.2, 5.0],
    max_steps: 400,
    enough_promised: 0.0,
    patience: (3, 1e-5),
    exact: 0.0,
};

/// Range and regularization of an unknown.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unknown {
    /// Initial value.
    pub(crate) start: f64,
    /// Smallest and largest value.
    pub(crate) bounds: [f64; 2],
    /// Value towards which it is regularized.
    pub(crate) center: f64,
    /// Cost of the regularization: this number times the squared distance from the center.
    pub(crate) pull: f64,
}

/// A cost with regularization.
struct Pulled<'a, N, C> {
    unknowns: &'a [Unknown],
    near: N,
    cost: C,
}

impl<E, N, C> Problem for Pulled<'_, N, C>
where
    N: FnMut(&[f64]) -> Result<Quadratic, E>,
    C: FnMut(&[f64]) -> Result<f64, E>,
{
    type At = ();
    type Error = E;

    fn evaluate(&mut self, x: &[f64]) -> Result<Option<(f64, ())>, E> {
        let own = self.unknowns.iter().zip(x);
        let pulls: f64 = own.map(|(u, x)| u.pull * (x - u.center).powi(2)).sum();
        Ok(Some(((self.cost)(x)? + pulls, ())))
    }

    fn near(&mut self, x: &[f64], (): &()) -> Result<Quadratic, E> {
        let mut near = (self.near)(x)?;
        let n = x.len();
        for (i, (u, x)) in self.unknowns.iter().zip(x).enumerate() {
            near.gradient[i] += 2.0 * u.pull * (x - u.center);
            near.matrix[i * n + i] += 2.0 * u.pull;
        }
        Ok(near)
    }
}

/// The point with the smallest cost. `near` gives the derivatives of the cost, `cost` its value.
pub(crate) fn minimize_robust<E>(
    unknowns: &[Unknown],
    near: impl FnMut(&[f64]) -> Result<Quadratic, E>,
    cost: impl FnMut(&[f64]) -> Result<f64, E>,
) -> Result<Vec<f64>, E> {
    let mut problem = Pulled { unknowns, near, cost };
    let ranges = unknowns.iter().map(|u| Range {
        bounds: u.bounds,
        reach: f64::INFINITY,
    });
    let ranges: Vec<Range> = ranges.collect();
    let inside = |u: &Unknown| u.start.clamp(u.bounds[0], u.bounds[1]);
    let start: Vec<f64> = unknowns.iter().map(inside).collect();
    let Some((cost, ())) = problem.evaluate(&start)? else {
        return Ok(start);
    };
    let found = minimize(&mut problem, &ranges, (start, cost, ()), &METHOD, &mut |_| ())?;
    Ok(found.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn free(start: f64) -> Unknown {
        Unknown {
            start,
            bounds: [-10.0, 10.0],
            center: 0.0,
            pull: 0.0,
        }
    }

    /// Distance of a straight line from points, one of which is an outlier.
    fn line(x: &[f64]) -> (f64, Quadratic) {
        let mut cost = 0.0;
        let mut quadratic = Quadratic {
            gradient: vec![0.0; 2],
            matrix: vec![0.0; 4],
        };
        for i in 0..20 {
            let t = f64::from(i) / 10.0;
            let measured = 1.0 - 2.0 * t + if i == 7 { 30.0 } else { 0.0 };
            let residual = x[0] + x[1] * t - measured;
            let size = residual.hypot(1e-4);
            cost += size;
            let row = [1.0, t];
            for a in 0..2 {
                quadratic.gradient[a] += row[a] * residual / size;
                for b in 0..2 {
                    quadratic.matrix[2 * a + b] += row[a] * row[b] / size;
                }
            }
        }
        (cost, quadratic)
    }

    #[test]
    fn an_outlier_does_not_move_a_line() {
        let near = |x: &[f64]| Ok::<_, ()>(line(x).1);
        let x = minimize_robust(&[free(3.0), free(3.0)], near, |x| Ok(line(x).0)).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-3 && (x[1] + 2.0).abs() < 1e-3, "{x:?}");
    }

    #[test]
    fn bounds_and_pulls_hold() {
        let near = |x: &[f64]| Ok::<_, ()>(line(x).1);
        let bounded = Unknown {
            bounds: [-1.5, 10.0],
            ..free(3.0)
        };
        let x = minimize_robust(&[free(3.0), bounded], near, |x| Ok(line(x).0)).unwrap();
        assert_eq!(x[1], -1.5);
        let pulled = Unknown {
            center: 5.0,
            pull: 1e9,
            ..free(3.0)
        };
        let x = minimize_robust(&[free(3.0), pulled], near, |x| Ok(line(x).0)).unwrap();
        assert!((x[1] - 5.0).abs() < 1e-3, "{x:?}");
    }
}
