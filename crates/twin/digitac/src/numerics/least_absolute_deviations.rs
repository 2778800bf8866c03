//! Linear fits with nonnegative coefficients that are robust to outliers. `faer` has no solver with
//! bounds.

/// Number of rounds of reweighting.
const ROUNDS: usize = 12;
/// Residuals below this fraction of the largest target are weighted quadratically, larger ones
/// linearly: the corner of Huber's loss.
const CORNER: f64 = 2e-3;
/// Number of rounds over the coefficients in coordinate descent.
const DESCENTS: usize = 200;

/// Coefficients a ≥ 0 for which Σ a columns approximates the target in the sense of least absolute
/// deviations (iteratively reweighted least squares), and the mean absolute deviation. Columns of
/// zeros get the coefficient zero.
pub(crate) fn fit_nonnegative(columns: &[Vec<f64>], target: &[f64]) -> (Vec<f64>, f64) {
    let n_columns = columns.len();
    let mut coefficients = vec![0.0; n_columns];
    let corner = CORNER * target.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    if target.is_empty() || corner == 0.0 {
        return (coefficients, 0.0);
    }
    let mut weights = vec![1.0; target.len()];
    let mut residuals = target.to_vec();
    for _ in 0..ROUNDS {
        let (matrix, right) = normal_equations(columns, target, &weights);
        descend(&matrix, &right, &mut coefficients);
        for (i, residual) in residuals.iter_mut().enumerate() {
            *residual = target[i]
                - columns
                    .iter()
                    .zip(&coefficients)
                    .map(|(c, a)| a * c[i])
                    .sum::<f64>();
        }
        for (weight, residual) in weights.iter_mut().zip(&residuals) {
            *weight = 1.0 / residual.abs().max(corner);
        }
    }
    let deviation = residuals.iter().map(|r| r.abs()).sum::<f64>() / target.len() as f64;
    (coefficients, deviation)
}

/// Weighted normal matrix, row by row, and right-hand side.
fn normal_equations(columns: &[Vec<f64>], target: &[f64], weights: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let n = columns.len();
    let mut matrix = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = columns[i]
                .iter()
                .zip(&columns[j])
                .zip(weights)
                .map(|((a, b), w)| w * a * b)
                .sum();
            matrix[i * n + j] = sum;
            matrix[j * n + i] = sum;
        }
    }
    let right = columns.iter().map(|c| {
        c.iter()
            .zip(target)
            .zip(weights)
            .map(|((a, y), w)| w * a * y)
            .sum()
    });
    (matrix, right.collect())
}

/// Minimizes the quadratic function over a ≥ 0, one coefficient after another.
fn descend(matrix: &[f64], right: &[f64], coefficients: &mut [f64]) {
    let n = right.len();
    for _ in 0..DESCENTS {
        let mut moved: f64 = 0.0;
        for i in 0..n {
            let diagonal = matrix[i * n + i];
            if diagonal <= 0.0 {
                continue;
            }
            let row = &matrix[i * n..(i + 1) * n];
            let slope = right[i]
                - row
                    .iter()
                    .zip(coefficients.iter())
                    .map(|(m, a)| m * a)
                    .sum::<f64>();
            let next = (coefficients[i] + slope / diagonal).max(0.0);
            moved = moved.max((next - coefficients[i]).abs() / next.abs().max(1e-12));
            coefficients[i] = next;
        }
        if moved < 1e-10 {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outliers_and_useless_columns_do_not_matter() {
        let a: Vec<f64> = (0..200).map(|i| f64::from(i) / 200.0).collect();
        let b: Vec<f64> = a.iter().map(|x| (9.0 * x).sin()).collect();
        let opposed: Vec<f64> = a.iter().map(|x| -x * x).collect();
        let mut target: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 3.0 * a + 0.5 * b).collect();
        for i in (0..200).step_by(17) {
            target[i] += 5.0;
        }
        let (fit, _) = fit_nonnegative(&[a, b, opposed, vec![0.0; 200]], &target);
        assert!(
            (fit[0] - 3.0).abs() < 0.01 && (fit[1] - 0.5).abs() < 0.01,
            "{fit:?}"
        );
        assert!(fit[2] < 0.01 && fit[3] == 0.0, "{fit:?}");
    }

    #[test]
    fn nothing_is_fitted_by_nothing() {
        assert_eq!(fit_nonnegative(&[vec![]], &[]), (vec![0.0], 0.0));
        assert_eq!(fit_nonnegative(&[vec![1.0, 2.0]], &[0.0, 0.0]), (vec![0.0], 0.0));
    }
}
