//! Small symmetric matrices.

use crate::model::N;

pub(crate) type Vector = [f64; N];

pub(crate) type Matrix = [[f64; N]; N];

/// The lower triangular (Cholesky) factor of a positive definite matrix. Values above the diagonal
/// are those of the matrix.
pub(crate) fn triangle(matrix: &Matrix) -> Matrix {
    let mut lower = *matrix;
    twintac_fit::factorize(lower.as_flattened_mut(), N);
    lower
}

/// Solves a system of equations with its triangular factor.
pub(crate) fn solve(lower: &Matrix, mut right: Vector) -> Vector {
    twintac_fit::solve_by(lower.as_flattened(), &mut right);
    right
}

/// The inverse of a positive definite matrix, and the logarithm of the determinant of the matrix.
pub(crate) fn inverse(matrix: &Matrix) -> (Matrix, f64) {
    let lower = triangle(matrix);
    let mut inverse = [[0.0; N]; N];
    for (number, column) in inverse.iter_mut().enumerate() {
        let unit = std::array::from_fn(|row| f64::from(u8::from(row == number)));
        *column = solve(&lower, unit);
    }
    let logarithm = (0..N).map(|row| 2.0 * lower[row][row].ln()).sum();
    (inverse, logarithm)
}

/// `vᵀ M v`.
pub(crate) fn form(matrix: &Matrix, vector: &Vector) -> f64 {
    let product = times(matrix, vector);
    product.iter().zip(vector).map(|(a, b)| a * b).sum()
}

pub(crate) fn times(matrix: &Matrix, vector: &Vector) -> Vector {
    matrix.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn an_inverse_undoes_its_matrix(values in prop::array::uniform16(-1.0..1.0f64), right in prop::array::uniform4(-1.0..1.0f64)) {
            let root: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| values[N * row + column]));
            let matrix: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| {
                let product: f64 = (0..N).map(|k| root[row][k] * root[column][k]).sum();
                product + if row == column { 0.1 } else { 0.0 }
            }));
            let (inverse, logarithm) = inverse(&matrix);
            let found = times(&inverse, &times(&matrix, &right));
            let solved = times(&matrix, &solve(&triangle(&matrix), right));
            for row in 0..N {
                prop_assert!((found[row] - right[row]).abs() < 1e-9);
                prop_assert!((solved[row] - right[row]).abs() < 1e-9);
            }
            prop_assert!(logarithm.is_finite());
        }
    }
}
