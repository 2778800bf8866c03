//! Sums of products, of which layers consist.

use pulp::Simd;

use crate::simd::{lanes, vectors};

/// Numbers of vectors of a row of sums that are held in registers: the first that divides a row is
/// used.
const WIDTHS: [usize; 3] = [4, 2, 1];

/// Rows of weights, padded with zeros.
#[derive(Clone, Debug)]
pub(super) struct Weights {
    /// In the order in which they are needed. `[n_outputs / n_block][n_factors][n_block]`
    numbers: Vec<f32>,
    /// Outputs that are summed together.
    n_block: usize,
    n_factors: usize,
}

impl Weights {
    /// From rows of whole vectors. `[n_factors][n_outputs]`
    pub(super) fn of(rows: &[f32], n_outputs: usize) -> Self {
        let n_vectors = n_outputs / lanes();
        let n_columns = WIDTHS.into_iter().find(|width| n_vectors.is_multiple_of(*width));
        let n_block = n_columns.unwrap_or(1) * lanes();
        let blocks = (0..n_outputs).step_by(n_block);
        let numbers = blocks.flat_map(|first| {
            rows.chunks_exact(n_outputs)
                .flat_map(move |row| &row[first..first + n_block])
        });
        Self {
            numbers: numbers.copied().collect(),
            n_block,
            n_factors: rows.len() / n_outputs,
        }
    }

    /// Whether all outputs are one vector.
    pub(super) fn is_narrow<S: Simd>(&self) -> bool {
        self.numbers.len() == self.n_factors * S::F32_LANES
    }

    /// Adds the rows of weights, each multiplied by a factor, to some rows of sums, in the order of
    /// the factors: a row has the same bits whatever other rows there are.
    ///
    /// - `factors`: those of each row. `[n_factors]`
    /// - `starts`: where the rows start in the sums.
    #[inline(always)]
    pub(super) fn add<S: Simd, const ROWS: usize>(
        &self,
        simd: S,
        factors: [&[f32]; ROWS],
        mut starts: [usize; ROWS],
        sums: &mut [f32],
    ) {
        let mut numbers = self.numbers.as_slice();
        // `chunks_exact` would divide.
        while !numbers.is_empty() {
            let (block, others) = numbers.split_at(self.n_factors * self.n_block);
            numbers = others;
            match self.n_block / S::F32_LANES {
                4 => add_block::<S, ROWS, 4>(simd, block, factors, starts, sums),
                2 => add_block::<S, ROWS, 2>(simd, block, factors, starts, sums),
                _ => add_block::<S, ROWS, 1>(simd, block, factors, starts, sums),
            }
            for start in &mut starts {
                *start += self.n_block;
            }
        }
    }
}

/// Processes a block of `N` vectors of outputs.
#[inline(always)]
#[allow(clippy::needless_range_loop)] // plain loops stay in registers
fn add_block<S: Simd, const ROWS: usize, const N: usize>(
    simd: S,
    block: &[f32],
    factors: [&[f32]; ROWS],
    starts: [usize; ROWS],
    sums: &mut [f32],
) {
    let n_own = N * S::F32_LANES;
    let mut own = [[simd.splat_f32s(0.0); N]; ROWS];
    for row in 0..ROWS {
        own[row].copy_from_slice(&S::as_simd_f32s(&sums[starts[row]..starts[row] + n_own]).0[..N]);
    }
    for (number, weights) in vectors::<S>(block).as_chunks::<N>().0.iter().enumerate() {
        for row in 0..ROWS {
            let factor = simd.splat_f32s(factors[row][number]);
            for column in 0..N {
                own[row][column] = simd.mul_add_f32s(factor, weights[column], own[row][column]);
            }
        }
    }
    for row in 0..ROWS {
        let sums = S::as_mut_simd_f32s(&mut sums[starts[row]..starts[row] + n_own]).0;
        sums[..N].copy_from_slice(&own[row]);
    }
}
