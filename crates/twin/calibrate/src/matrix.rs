//! Small dense symmetric matrices.

/// A square matrix by rows.
pub(crate) type Square = Vec<Vec<f64>>;

/// Eigenvalues, and for each its unit eigenvector, by Jacobi's rotations (Golub and Van Loan, Matrix Computations, 2013, section 8.5).
pub(crate) fn eigen(matrix: &Square) -> (Vec<f64>, Square) {
    const MAX_SWEEPS: usize = 50;
    let n = matrix.len();
    let mut a = matrix.clone();
    let mut vectors: Square = (0..n)
        .map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect())
        .collect();
    for _ in 0..MAX_SWEEPS {
        let off: f64 = (0..n).map(|i| (0..i).map(|j| a[i][j].powi(2)).sum::<f64>()).sum();
        let diagonal: f64 = (0..n).map(|i| a[i][i].powi(2)).sum();
        if off <= 1e-32 * diagonal {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let (cosine, sine) = (1.0 / t.hypot(1.0), t / t.hypot(1.0));
                for row in a.iter_mut() {
                    (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
                }
                for k in 0..n {
                    (a[p][k], a[q][k]) = (
                        cosine * a[p][k] - sine * a[q][k],
                        sine * a[p][k] + cosine * a[q][k],
                    );
                    let vector = &mut vectors;
                    (vector[p][k], vector[q][k]) = (
                        cosine * vector[p][k] - sine * vector[q][k],
                        sine * vector[p][k] + cosine * vector[q][k],
                    );
                }
            }
        }
    }
    ((0..n).map(|i| a[i][i]).collect(), vectors)
}

/// The solution of a positive definite system by Cholesky's factors; none if it is not positive definite.
pub(crate) fn solve(matrix: &Square, right: &[f64]) -> Option<Vec<f64>> {
    let n = right.len();
    let mut lower = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let left = matrix[i][j] - sum;
            lower[i][j] = if i == j {
                if left.is_nan() || left <= 0.0 {
                    return None;
                }
                left.sqrt()
            } else {
                left / lower[j][j]
            };
        }
    }
    let mut x = right.to_vec();
    for i in 0..n {
        let sum: f64 = (0..i).map(|k| lower[i][k] * x[k]).sum();
        x[i] = (x[i] - sum) / lower[i][i];
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|k| lower[k][i] * x[k]).sum();
        x[i] = (x[i] - sum) / lower[i][i];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use super::*;

    #[test]
    fn eigenvectors_rebuild_the_matrix_and_solutions_solve_it() {
        let matrix = vec![
            vec![4.0, 1.0, -2.0, 0.3],
            vec![1.0, 3.0, 0.5, 0.1],
            vec![-2.0, 0.5, 5.0, -0.7],
            vec![0.3, 0.1, -0.7, 1e-3 + 0.4],
        ];
        let (values, vectors) = eigen(&matrix);
        for i in 0..4 {
            for j in 0..4 {
                let sum: f64 = (0..4).map(|k| values[k] * vectors[k][i] * vectors[k][j]).sum();
                assert!((sum - matrix[i][j]).abs() < 1e-12);
            }
        }
        let x = solve(&matrix, &[1.0, -2.0, 0.5, 3.0]).unwrap();
        for (row, right) in matrix.iter().zip([1.0, -2.0, 0.5, 3.0]) {
            let sum: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
            assert!((sum - right).abs() < 1e-12);
        }
        assert!(solve(&vec![vec![1.0, 2.0], vec![2.0, 1.0]], &[1.0, 1.0]).is_none());
    }
}
