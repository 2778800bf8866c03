//! Systems of linear equations with a positive definite matrix.

/// Solves by Cholesky's method; only the lower triangle is read. Not faer's: `digitac` needs nothing else of faer, which takes longer to
/// compile than `digitac` itself, and these sums have the same order, and so the same bits, on every processor.
pub(crate) fn solve_symmetric(mut matrix: Vec<f64>, right: Vec<f64>) -> Vec<f64> {
    factorize(&mut matrix, right.len());
    solve_factorized(&matrix, right)
}

/// Puts the lower triangular factor in the place of the lower triangle; `[n * n]`.
fn factorize(l: &mut [f64], n: usize) {
    for i in 0..n {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum();
            let left = l[i * n + j] - dot;
            l[i * n + j] = if i == j {
                left.max(f64::MIN_POSITIVE).sqrt()
            } else {
                left / l[j * n + j]
            };
        }
    }
}

fn solve_factorized(l: &[f64], mut x: Vec<f64>) -> Vec<f64> {
    let n = x.len();
    for i in 0..n {
        let dot: f64 = (0..i).map(|k| l[i * n + k] * x[k]).sum();
        x[i] = (x[i] - dot) / l[i * n + i];
    }
    for i in (0..n).rev() {
        let dot: f64 = (i + 1..n).map(|k| l[k * n + i] * x[k]).sum();
        x[i] = (x[i] - dot) / l[i * n + i];
    }
    x
}

/// The inverse of a positive definite matrix, of which only the lower triangle is read, for the unknowns that are free; zero for all others.
/// Row by row; `[n * n]`.
pub(crate) fn inverse_symmetric(matrix: &[f64], is_free: &[bool]) -> Vec<f64> {
    let n = is_free.len();
    let free: Vec<usize> = (0..n).filter(|&i| is_free[i]).collect();
    let mut part: Vec<f64> = free
        .iter()
        .flat_map(|&i| free.iter().map(move |&j| matrix[i.max(j) * n + i.min(j)]))
        .collect();
    factorize(&mut part, free.len());
    let mut inverse = vec![0.0; n * n];
    for (a, &i) in free.iter().enumerate() {
        let mut unit = vec![0.0; free.len()];
        unit[a] = 1.0;
        for (&j, value) in free.iter().zip(solve_factorized(&part, unit)) {
            inverse[i * n + j] = value;
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverse_undoes_its_matrix_where_unknowns_are_free() {
        let matrix = [4.0, 0.0, 0.0, 9.0, 9.0, 0.0, 1.0, 7.0, 3.0];
        let inverse = inverse_symmetric(&matrix, &[true, false, true]);
        let expected = [
            3.0 / 11.0,
            0.0,
            -1.0 / 11.0,
            0.0,
            0.0,
            0.0,
            -1.0 / 11.0,
            0.0,
            4.0 / 11.0,
        ];
        for (found, expected) in inverse.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{inverse:?}");
        }
    }
}
