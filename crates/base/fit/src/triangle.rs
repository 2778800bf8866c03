//! Linear systems with a positive definite matrix.

/// Smallest pivot, as a fraction of the matrix entry on the diagonal.
const SMALLEST_PIVOT: f64 = 1e-12;

/// The lower triangular Cholesky factor `L` of a positive definite matrix `A = L Lᵀ`. A pivot that
/// is not positive because of rounding is replaced by a tiny one.
///
/// ```
/// let triangle = twintac_fit::Triangle::of(vec![4.0, 0.0, 1.0, 3.0], 2); // 4 1; 1 3
/// assert_eq!(triangle.solve(vec![9.0, 5.0]), [2.0, 1.0]);
/// ```
#[derive(Clone, Debug)]
pub struct Triangle {
    /// Row by row; `[n * n]`.
    lower: Vec<f64>,
    n: usize,
}

impl Triangle {
    /// Factorizes a matrix of `n` rows, given row by row. Only its lower triangle is read.
    ///
    /// # Panics
    /// The matrix has other than `n * n` entries.
    #[must_use]
    pub fn of(mut matrix: Vec<f64>, n: usize) -> Self {
        assert_eq!(matrix.len(), n * n, "a matrix of {n} rows has {n} columns");
        factorize(&mut matrix, n);
        Self { lower: matrix, n }
    }

    /// Solves the system for a right side; `[n]`.
    ///
    /// # Panics
    /// The right side has other than `n` entries.
    #[must_use]
    pub fn solve(&self, mut right: Vec<f64>) -> Vec<f64> {
        assert_eq!(right.len(), self.n, "there is a right side for each row");
        solve_by(&self.lower, &mut right);
        right
    }

    /// The inverse of the matrix, row by row; `[n * n]`.
    #[must_use]
    pub fn inverse(&self) -> Vec<f64> {
        let unit = |row: usize| (0..self.n).map(move |column| f64::from(u8::from(row == column)));
        (0..self.n)
            .flat_map(|row| self.solve(unit(row).collect()))
            .collect()
    }
}

/// Replaces the lower triangle of a matrix of `n` rows by its Cholesky factor (see [`Triangle`]);
/// for small matrices that are not in a vector.
#[inline]
pub fn factorize(l: &mut [f64], n: usize) {
    for i in 0..n {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum();
            let left = l[i * n + j] - dot;
            l[i * n + j] = if i == j {
                let smallest = SMALLEST_PIVOT * l[i * n + i].abs();
                left.max(smallest).max(f64::MIN_POSITIVE).sqrt()
            } else {
                left / l[j * n + j]
            };
        }
    }
}

/// Replaces the right side of a system by its solution, given the Cholesky factor of the matrix.
#[inline]
pub fn solve_by(l: &[f64], x: &mut [f64]) {
    let n = x.len();
    for i in 0..n {
        let dot: f64 = (0..i).map(|k| l[i * n + k] * x[k]).sum();
        x[i] = (x[i] - dot) / l[i * n + i];
    }
    for i in (0..n).rev() {
        let dot: f64 = (i + 1..n).map(|k| l[k * n + i] * x[k]).sum();
        x[i] = (x[i] - dot) / l[i * n + i];
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn an_inverse_undoes_its_matrix(values in prop::array::uniform16(-1.0..1.0f64), right in prop::array::uniform4(-1.0..1.0f64)) {
            let root = |row: usize, column: usize| values[4 * row + column];
            let entry = |row: usize, column: usize| {
                (0..4).map(|k| root(row, k) * root(column, k)).sum::<f64>() + if row == column { 0.1 } else { 0.0 }
            };
            let times = |x: &[f64]| -> Vec<f64> { (0..4).map(|row| (0..4).map(|k| entry(row, k) * x[k]).sum()).collect() };
            let triangle = Triangle::of((0..16).map(|k| entry(k / 4, k % 4)).collect(), 4);
            let inverse = triangle.inverse();
            let solved = triangle.solve(right.to_vec());
            for (row, (found, expected)) in times(&solved).iter().zip(right).enumerate() {
                prop_assert!((found - expected).abs() < 1e-9);
                let by_inverse: f64 = (0..4).map(|k| inverse[4 * row + k] * right[k]).sum();
                prop_assert!((by_inverse - solved[row]).abs() < 1e-9);
            }
        }
    }
}
