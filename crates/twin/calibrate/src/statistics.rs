//! How well the unknowns of a fit are known, from its Jacobian and what is left unexplained.

use crate::matrix::{Square, eigen};

/// Condition index of the Jacobian, its columns of unit length, from which unknowns are hard to tell apart (Belsley, Kuh and Welsch,
/// Regression Diagnostics, 1980, section 3.2).
pub(crate) const HARD_TO_TELL: f64 = 30.0;

/// Condition index from which they can't be told at all: about what the accuracy of the derivatives allows.
const IMPOSSIBLE_TO_TELL: f64 = 1e4;

/// A part of a direction above this takes part in it.
const TAKES_PART: f64 = 0.1;

/// Covariance of the unknowns, and how far they can be told apart.
pub(crate) struct Covariance {
    /// Infinite for what the data do not tell. `[n][n]`
    pub(crate) covariance: Square,
    /// Largest over smallest singular value of the Jacobian, its columns of unit length.
    pub(crate) condition: f64,
    /// Which unknowns take part in the worst told combination.
    pub(crate) worst: Vec<usize>,
    /// Which unknowns are in no way told by the data.
    pub(crate) untold: Vec<usize>,
}

/// The covariance `s² (JᵀJ)⁻¹` of a fit whose residuals are independent, all of the same variance `s²` (Seber and Wild, Nonlinear
/// Regression, 1989, section 2.1.2).
pub(crate) fn covariance(normal: &Square, variance: f64) -> Covariance {
    let n = normal.len();
    let lengths: Vec<f64> = (0..n).map(|i| normal[i][i].sqrt()).collect();
    // A column of zeros stays one.
    let safe = |i: usize| if lengths[i] > 0.0 { lengths[i] } else { 1.0 };
    let scaled: Square = (0..n)
        .map(|i| (0..n).map(|j| normal[i][j] / (safe(i) * safe(j))).collect())
        .collect();
    let (values, vectors) = eigen(&scaled);
    let largest = values.iter().copied().fold(0.0, f64::max);
    let index = |value: f64| (largest / value.max(0.0)).sqrt();
    let smallest = (0..n)
        .min_by(|&a, &b| values[a].total_cmp(&values[b]))
        .unwrap_or(0);
    let partners = |direction: usize| -> Vec<usize> {
        (0..n)
            .filter(|&i| vectors[direction][i].abs() > TAKES_PART)
            .collect()
    };
    let mut covariance = vec![vec![0.0; n]; n];
    let mut untold = Vec::new();
    for direction in 0..n {
        if index(values[direction]) > IMPOSSIBLE_TO_TELL {
            untold.extend(partners(direction));
            continue;
        }
        for i in 0..n {
            for j in 0..n {
                covariance[i][j] += variance * vectors[direction][i] * vectors[direction][j]
                    / (values[direction] * safe(i) * safe(j));
            }
        }
    }
    untold.sort_unstable();
    untold.dedup();
    for &i in &untold {
        covariance[i][i] = f64::INFINITY;
    }
    Covariance {
        covariance,
        condition: values.get(smallest).map_or(1.0, |value| index(*value)),
        worst: if n > 0 { partners(smallest) } else { Vec::new() },
        untold,
    }
}

/// Value that a standard normal variable stays below with this probability, by Newton's method.
fn normal_quantile(probability: f64) -> f64 {
    let mut x = 0.0_f64;
    for _ in 0..100 {
        let density = (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
        let step = (normal_cumulative(x) - probability) / density.max(1e-300);
        x -= step.clamp(-1.0, 1.0);
        if step.abs() < 1e-13 {
            break;
        }
    }
    x
}

/// `Φ(x) = 1/2 + φ(x) Σ x^(2k+1)/(1·3·…·(2k+1))` (Abramowitz and Stegun, 1964, 26.2.11).
fn normal_cumulative(x: f64) -> f64 {
    let (mut term, mut sum) = (x, x);
    let mut k = 1.0;
    while term.abs() > 1e-17 * sum.abs() && k < 500.0 {
        k += 2.0;
        term *= x * x / k;
        sum += term;
    }
    0.5 + sum * (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt()
}

/// The same for Student's distribution (Abramowitz and Stegun, 1964, 26.7.5): within 0.2 % for 5 degrees of freedom or more at 97.5 %.
pub(crate) fn student_quantile(probability: f64, degrees_of_freedom: f64) -> f64 {
    let x = normal_quantile(probability);
    let n = degrees_of_freedom;
    let first = (x.powi(3) + x) / 4.0;
    let second = (5.0 * x.powi(5) + 16.0 * x.powi(3) + 3.0 * x) / 96.0;
    let third = (3.0 * x.powi(7) + 19.0 * x.powi(5) + 17.0 * x.powi(3) - 15.0 * x) / 384.0;
    x + first / n + second / n.powi(2) + third / n.powi(3)
}

/// Correlation of neighbours: near zero for noise, near one where the model is wrong.
pub(crate) fn neighbour_correlation(residuals: &[f64]) -> f64 {
    let squares: f64 = residuals.iter().map(|r| r * r).sum();
    let products: f64 = residuals.windows(2).map(|pair| pair[0] * pair[1]).sum();
    if squares > 0.0 { products / squares } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        assert!((normal_quantile(0.975) - 1.959_963_985).abs() < 1e-8);
        assert!((normal_quantile(0.05) + 1.644_853_627).abs() < 1e-8);
        for (n, quantile) in [(5.0, 2.5706), (10.0, 2.2281), (30.0, 2.0423), (1e6, 1.96)] {
            assert!((student_quantile(0.975, n) / quantile - 1.0).abs() < 2e-3, "{n}");
        }
    }

    #[test]
    fn columns_that_are_alike_can_not_be_told() {
        let told = covariance(&vec![vec![4.0, 1.0], vec![1.0, 9.0]], 2.0);
        // The inverse is [9, -1; -1, 4]/35.
        assert!((told.covariance[0][0] - 2.0 * 9.0 / 35.0).abs() < 1e-12);
        assert!((told.covariance[0][1] + 2.0 / 35.0).abs() < 1e-12);
        assert!(told.condition < 2.0 && told.untold.is_empty());
        let alike = covariance(
            &vec![vec![1.0, 2.0, 0.0], vec![2.0, 4.0, 0.0], vec![0.0, 0.0, 1.0]],
            1.0,
        );
        assert_eq!(alike.untold, [0, 1]);
        assert!(alike.covariance[0][0].is_infinite() && (alike.covariance[2][2] - 1.0).abs() < 1e-12);
        let silent = covariance(&vec![vec![0.0, 0.0], vec![0.0, 1.0]], 1.0);
        assert_eq!(silent.untold, [0]);
    }
}
