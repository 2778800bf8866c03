//! Minimization of a sum of robust penalties within bounds: Levenberg (1944) and Marquardt (1963), with the Gauss-Newton matrix of reweighted
//! residuals. faer has no such solver.

use super::solve_symmetric;

/// Steps that lower the cost by less than this fraction do not count as progress.
const ENOUGH: f64 = 1e-5;
/// So many steps without progress end the search.
const PATIENCE: u32 = 3;
/// Steps at most.
const MAX_STEPS: u32 = 80;
/// Damping at first, at least and at most.
const DAMPING: [f64; 3] = [1e-3, 1e-9, 1e7];

/// Where an unknown may be, and what holds it back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unknown {
    /// Where the search starts.
    pub(crate) start: f64,
    /// Smallest and largest value.
    pub(crate) bounds: [f64; 2],
    /// Value to which it is pulled.
    pub(crate) center: f64,
    /// The pull's cost: this times the squared distance from the center.
    pub(crate) pull: f64,
}

/// A cost near a point: gradient and Gauss-Newton matrix, of which only the lower triangle is read; `[n * n]`.
pub(crate) struct Quadratic {
    pub(crate) gradient: Vec<f64>,
    pub(crate) matrix: Vec<f64>,
}

/// The point with the smallest cost, and the cost. `near` gives the slopes of the cost, `cost` its value.
pub(crate) fn minimize_robust<E>(
    unknowns: &[Unknown],
    mut near: impl FnMut(&[f64]) -> Result<Quadratic, E>,
    mut cost: impl FnMut(&[f64]) -> Result<f64, E>,
) -> Result<(Vec<f64>, f64), E> {
    let n = unknowns.len();
    let pulls = |x: &[f64]| -> f64 {
        let own = unknowns.iter().zip(x);
        own.map(|(u, x)| u.pull * (x - u.center).powi(2)).sum()
    };
    let inside = |u: &Unknown, x: f64| x.clamp(u.bounds[0], u.bounds[1]);
    let mut x: Vec<f64> = unknowns.iter().map(|u| inside(u, u.start)).collect();
    let mut damping = DAMPING[0];
    let mut since_progress = 0;
    let mut value = cost(&x)? + pulls(&x);
    for _ in 0..MAX_STEPS {
        let mut here = near(&x)?;
        for (i, (u, x)) in unknowns.iter().zip(&x).enumerate() {
            here.gradient[i] += 2.0 * u.pull * (x - u.center);
            here.matrix[i * n + i] += 2.0 * u.pull;
        }
        // What stands at its bound and would leave it stays there.
        let is_free = |i: usize| {
            let [low, high] = unknowns[i].bounds;
            let leaves = x[i] <= low && here.gradient[i] > 0.0 || x[i] >= high && here.gradient[i] < 0.0;
            !leaves && here.matrix[i * n + i] > 0.0
        };
        let free: Vec<usize> = (0..n).filter(|&i| is_free(i)).collect();
        let mut improved = false;
        while damping < DAMPING[2] && !free.is_empty() {
            let mut matrix = vec![0.0; free.len() * free.len()];
            for (a, &i) in free.iter().enumerate() {
                for (b, &j) in free[..=a].iter().enumerate() {
                    let damped = if a == b { 1.0 + damping } else { 1.0 };
                    matrix[a * free.len() + b] = damped * here.matrix[i.max(j) * n + i.min(j)];
                }
            }
            let right = free.iter().map(|&i| -here.gradient[i]).collect();
            let step = solve_symmetric(matrix, right);
            let mut trial = x.clone();
            for (&i, step) in free.iter().zip(step) {
                trial[i] = inside(&unknowns[i], x[i] + step);
            }
            let found = cost(&trial)? + pulls(&trial);
            if found < value {
                since_progress = if found < (1.0 - ENOUGH) * value {
                    0
                } else {
                    since_progress + 1
                };
                (x, value) = (trial, found);
                damping = (0.2 * damping).max(DAMPING[1]);
                improved = true;
                break;
            }
            damping *= 5.0;
        }
        if !improved || since_progress >= PATIENCE {
            break;
        }
    }
    Ok((x, value))
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

    /// Distance of a straight line from points, of which one lies far off.
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
        let (x, _) = minimize_robust(&[free(3.0), free(3.0)], near, |x| Ok(line(x).0)).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-3 && (x[1] + 2.0).abs() < 1e-3, "{x:?}");
    }

    #[test]
    fn bounds_and_pulls_hold() {
        let near = |x: &[f64]| Ok::<_, ()>(line(x).1);
        let bounded = Unknown {
            bounds: [-1.5, 10.0],
            ..free(3.0)
        };
        let (x, _) = minimize_robust(&[free(3.0), bounded], near, |x| Ok(line(x).0)).unwrap();
        assert_eq!(x[1], -1.5);
        let pulled = Unknown {
            center: 5.0,
            pull: 1e9,
            ..free(3.0)
        };
        let (x, _) = minimize_robust(&[free(3.0), pulled], near, |x| Ok(line(x).0)).unwrap();
        assert!((x[1] - 5.0).abs() < 1e-3, "{x:?}");
    }
}
