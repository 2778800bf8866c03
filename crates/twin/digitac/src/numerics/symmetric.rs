//! Inverses of matrices for some of their unknowns.

use twintac_fit::Triangle;

/// The inverse of a positive definite matrix, of which only the lower triangle is read, for the
/// free unknowns; zero for all others. Row by row; `[n * n]`.
pub(crate) fn inverse_symmetric(matrix: &[f64], is_free: &[bool]) -> Vec<f64> {
    let n = is_free.len();
    let free: Vec<usize> = (0..n).filter(|&i| is_free[i]).collect();
    let part = free
        .iter()
        .flat_map(|&i| free.iter().map(move |&j| matrix[i.max(j) * n + i.min(j)]));
    let known = Triangle::of(part.collect(), free.len()).inverse();
    let mut inverse = vec![0.0; n * n];
    for (row, &i) in known.chunks(free.len().max(1)).zip(&free) {
        for (value, &j) in row.iter().zip(&free) {
            inverse[i * n + j] = *value;
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
