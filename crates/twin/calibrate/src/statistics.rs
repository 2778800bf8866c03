//! Covariance and identifiability of the unknowns of a fit, from its Jacobian and its residuals.

use faer::{Mat, Side};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Condition index of the Jacobian with columns of unit length, from which unknowns are hard to
/// separate (Belsley, Kuh and Welsch, Regression Diagnostics, 1980, section 3.2).
pub(crate) const HARD_TO_TELL: f64 = 30.0;

/// Condition index from which unknowns cannot be determined at all. It is about the limit set by
/// the accuracy of the derivatives.
const IMPOSSIBLE_TO_TELL: f64 = 1e4;

/// An unknown takes part in a direction if its component is larger than this.
const TAKES_PART: f64 = 0.1;

/// Covariance of the unknowns, and which of them the data determine.
pub(crate) struct Covariance {
    /// Variances are infinite for unknowns that the data do not determine; `[n][n]`.
    pub(crate) covariance: Mat<f64>,
    /// Ratio of the largest to the smallest singular value of the Jacobian with columns of unit
    /// length.
    pub(crate) condition: f64,
    /// Which unknowns take part in the worst determined combination.
    pub(crate) worst: Vec<usize>,
    /// Which unknowns the data do not determine.
    pub(crate) untold: Vec<usize>,
}

/// The covariance `s² (JᵀJ)⁻¹` of a fit whose residuals are independent and have the same variance
/// `s²` (Seber and Wild, Nonlinear Regression, 1989, section 2.1.2).
pub(crate) fn covariance(normal: &Mat<f64>, variance: f64) -> Covariance {
    let n = normal.nrows();
    // The length of each column of the Jacobian; 1 for a column of zeros.
    let length = |i: usize| {
        let square: f64 = normal[(i, i)];
        if square > 0.0 { square.sqrt() } else { 1.0 }
    };
    let scaled = Mat::from_fn(n, n, |i, j| normal[(i, j)] / (length(i) * length(j)));
    let eigen = scaled.self_adjoint_eigen(Side::Lower).ok();
    let Some(eigen) = eigen.filter(|_| scaled.is_all_finite()) else {
        // Derivatives that are NaN or infinite determine nothing.
        return Covariance {
            covariance: Mat::from_fn(n, n, |i, j| if i == j { f64::INFINITY } else { 0.0 }),
            condition: f64::INFINITY,
            worst: (0..n).collect(),
            untold: (0..n).collect(),
        };
    };
    // Eigenvalues ascend; the columns of `vectors` are their unit eigenvectors.
    let (values, vectors) = (eigen.S().column_vector(), eigen.U());
    let index = |direction: usize| (values[n - 1] / values[direction].max(0.0)).sqrt();
    let partners = |direction: usize| (0..n).filter(move |&i| vectors[(i, direction)].abs() > TAKES_PART);
    let mut covariance = Mat::zeros(n, n);
    let mut untold = Vec::new();
    for direction in 0..n {
        if index(direction) > IMPOSSIBLE_TO_TELL {
            untold.extend(partners(direction));
            continue;
        }
        for i in 0..n {
            for j in 0..n {
                covariance[(i, j)] += variance * vectors[(i, direction)] * vectors[(j, direction)]
                    / (values[direction] * length(i) * length(j));
            }
        }
    }
    untold.sort_unstable();
    untold.dedup();
    for &i in &untold {
        covariance[(i, i)] = f64::INFINITY;
    }
    Covariance {
        covariance,
        condition: if n > 0 { index(0) } else { 1.0 },
        worst: if n > 0 { partners(0).collect() } else { Vec::new() },
        untold,
    }
}

/// Quantile of Student's distribution, accurate to nine digits up to 10⁴ degrees of freedom and to
/// four up to 10⁶. NaN if there are no degrees of freedom.
pub(crate) fn student_quantile(probability: f64, degrees_of_freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, degrees_of_freedom)
        .map_or(f64::NAN, |distribution| distribution.inverse_cdf(probability))
}

/// Correlation of neighbouring residuals: near 0 for noise, near 1 where the model is wrong.
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
        for (n, quantile) in [
            (2.0, 4.302_653),
            (5.0, 2.570_582),
            (30.0, 2.042_272),
            (1e3, 1.962_339),
        ] {
            assert!((student_quantile(0.975, n) / quantile - 1.0).abs() < 1e-6, "{n}");
        }
    }

    #[test]
    fn columns_that_are_alike_can_not_be_told() {
        let told = covariance(&faer::mat![[4.0, 1.0], [1.0, 9.0]], 2.0);
        // The inverse is [9, -1; -1, 4]/35.
        assert!((told.covariance[(0, 0)] - 2.0 * 9.0 / 35.0).abs() < 1e-12);
        assert!((told.covariance[(0, 1)] + 2.0 / 35.0).abs() < 1e-12);
        assert!(told.condition < 2.0 && told.untold.is_empty());
        let alike = covariance(
            &faer::mat![[1.0, 2.0, 0.0], [2.0, 4.0, 0.0], [0.0, 0.0, 1.0]],
            1.0,
        );
        assert_eq!(alike.untold, [0, 1]);
        assert!(alike.covariance[(0, 0)].is_infinite() && (alike.covariance[(2, 2)] - 1.0).abs() < 1e-12);
        let unknown = covariance(&faer::mat![[f64::NAN, 0.0], [0.0, 1.0]], 1.0);
        assert_eq!(unknown.untold, [0, 1]);
        let silent = covariance(&faer::mat![[0.0, 0.0], [0.0, 1.0]], 1.0);
        assert_eq!(silent.untold, [0]);
    }
}
