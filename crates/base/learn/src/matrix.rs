//! Matrices of single precision, stored row by row.

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};

/// Rows of a tile of the product. With the widest tile below, the sums fill the vector registers.
const HEIGHT: usize = 6;

/// Columns of a tile: the widest that still fits is taken.
const WIDTHS: [usize; 4] = [16, 4, 2, 1];

/// Number of terms that are summed before they are added to the result.
const BLOCK: usize = 512;

/// A matrix of single precision, stored row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    /// The values, row by row; `[n_rows * n_columns]`.
    pub values: Vec<f32>,
    /// Number of columns.
    pub n_columns: usize,
}

impl Matrix {
    /// A matrix of zeros.
    #[must_use]
    pub fn zeros(n_rows: usize, n_columns: usize) -> Self {
        Self {
            values: vec![0.0; n_rows * n_columns],
            n_columns,
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn n_rows(&self) -> usize {
        self.values.len() / self.n_columns.max(1)
    }

    /// The rows, from the first.
    pub fn rows(&self) -> impl Iterator<Item = &[f32]> {
        self.values.chunks_exact(self.n_columns.max(1))
    }

    /// The rows, mutable.
    pub fn rows_mut(&mut self) -> impl Iterator<Item = &mut [f32]> {
        self.values.chunks_exact_mut(self.n_columns.max(1))
    }

    /// Sum of each column, from the first row to the last.
    #[must_use]
    pub fn column_sums(&self) -> Vec<f32> {
        let mut sums = vec![0.0; self.n_columns];
        for row in self.rows() {
            sums.iter_mut().zip(row).for_each(|(sum, value)| *sum += value);
        }
        sums
    }

    /// The transposed matrix.
    #[must_use]
    pub fn transposed(&self) -> Self {
        let (n_rows, n_columns) = (self.n_rows(), self.n_columns);
        let values = (0..n_columns).flat_map(|j| (0..n_rows).map(move |i| self.values[i * n_columns + j]));
        Self {
            values: values.collect(),
            n_columns: n_rows,
        }
    }

    /// The product `self · right`. Its terms are added in a fixed order, with fused multiplication
    /// and addition, so that every processor gives the same bits.
    #[must_use]
    pub fn times(&self, right: &Self) -> Self {
        self.product(self.n_rows(), [self.n_columns, 1], right)
    }

    /// Writes the product into an existing matrix and sets its size. Each row has the same bits
    /// whatever number of rows there is.
    pub(crate) fn times_into(&self, right: &Self, result: &mut Self) {
        result.values.clear();
        result.values.resize(self.n_rows() * right.n_columns, 0.0);
        result.n_columns = right.n_columns;
        multiply(&self.values, [self.n_columns, 1], right, result);
    }

    /// The product `selfᵀ · right`.
    #[must_use]
    pub fn transposed_times(&self, right: &Self) -> Self {
        self.product(self.n_columns, [1, self.n_columns], right)
    }

    /// The product with a left matrix whose rows and columns are `strides` apart in memory.
    fn product(&self, n_rows: usize, strides: [usize; 2], right: &Self) -> Self {
        let mut result = Self::zeros(n_rows, right.n_columns);
        multiply(&self.values, strides, right, &mut result);
        result
    }
}

/// Adds a product to `result`; rows and columns of the left matrix are `strides` apart in memory.
fn multiply(left: &[f32], strides: [usize; 2], right: &Matrix, result: &mut Matrix) {
    Arch::new().dispatch(Product {
        left,
        strides,
        right,
        result,
    });
}

/// A product, compiled for each instruction set. faer's product leaves the upper halves of vector
/// registers set, which makes the exponentials that follow thirty times slower.
struct Product<'a> {
    left: &'a [f32],
    strides: [usize; 2],
    right: &'a Matrix,
    result: &'a mut Matrix,
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        let (n_rows, n_terms) = (self.result.n_rows(), self.right.n_rows());
        for start in (0..n_terms).step_by(BLOCK) {
            let terms = start..n_terms.min(start + BLOCK);
            let mut row = 0;
            while row + HEIGHT <= n_rows {
                self.rows::<HEIGHT>(row, terms.clone());
                row += HEIGHT;
            }
            while row < n_rows {
                self.rows::<1>(row, terms.clone());
                row += 1;
            }
        }
    }
}

impl Product<'_> {
    #[inline(always)]
    fn rows<const H: usize>(&mut self, row: usize, terms: Range<usize>) {
        let n_columns = self.result.n_columns;
        let mut column = 0;
        while column < n_columns {
            let terms = terms.clone();
            column += match n_columns - column {
                left if left >= WIDTHS[0] => self.tile::<H, { WIDTHS[0] }>(row, column, terms),
                left if left >= WIDTHS[1] => self.tile::<H, { WIDTHS[1] }>(row, column, terms),
                left if left >= WIDTHS[2] => self.tile::<H, { WIDTHS[2] }>(row, column, terms),
                _ => self.tile::<H, { WIDTHS[3] }>(row, column, terms),
            };
        }
    }

    /// Computes one tile, and returns its number of columns.
    #[inline(always)]
    fn tile<const H: usize, const W: usize>(
        &mut self,
        row: usize,
        column: usize,
        terms: Range<usize>,
    ) -> usize {
        let [row_stride, term_stride] = self.strides;
        let n_columns = self.right.n_columns;
        let mut sums = [[0.0_f32; W]; H];
        for term in terms {
            let from = term * n_columns + column;
            let right = &self.right.values[from..from + W];
            for (h, sums) in sums.iter_mut().enumerate() {
                let left = self.left[(row + h) * row_stride + term * term_stride];
                for (sum, right) in sums.iter_mut().zip(right) {
                    *sum = left.mul_add(*right, *sum);
                }
            }
        }
        for (h, sums) in sums.iter().enumerate() {
            let to = (row + h) * n_columns + column;
            let result = &mut self.result.values[to..to + W];
            result
                .iter_mut()
                .zip(sums)
                .for_each(|(result, sum)| *result += sum);
        }
        W
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(n_rows: usize, n_columns: usize) -> Matrix {
        Matrix {
            values: (0..n_rows * n_columns).map(|i| (1.7 * i as f32).sin()).collect(),
            n_columns,
        }
    }

    #[test]
    fn products_are_sums_of_products_at_any_size() {
        for (n_rows, n_terms, n_columns) in [(1, 1, 1), (5, 3, 9), (4, 600, 8), (13, 7, 26)] {
            let (left, right) = (wave(n_rows, n_terms), wave(n_terms, n_columns));
            let product = left.times(&right);
            for i in 0..n_rows {
                for j in 0..n_columns {
                    let term = |k| {
                        f64::from(left.values[i * n_terms + k]) * f64::from(right.values[k * n_columns + j])
                    };
                    let expected: f64 = (0..n_terms).map(term).sum();
                    let found = f64::from(product.values[i * n_columns + j]);
                    assert!((found - expected).abs() < 1e-4, "{found}, expected {expected}");
                }
            }
            assert_eq!(left.transposed().transposed_times(&right), product);
            let mut row = Matrix::zeros(0, 0);
            for (left, product) in left.rows().zip(product.rows()) {
                let left = Matrix {
                    values: left.to_vec(),
                    n_columns: n_terms,
                };
                left.times_into(&right, &mut row);
                assert_eq!(row.values, product);
            }
        }
    }
}
