//! A dense layer: every input is multiplied.

use pulp::Simd;
use twintac_learn::Linear;

use super::product::Weights;
use crate::simd::lanes;

/// Rows that are processed together.
const ROWS: usize = 2;

/// Rows that are processed together where the outputs of a layer are one vector.
const NARROW_ROWS: usize = 8;

/// A layer, its outputs padded with zeros to whole vectors.
#[derive(Clone, Debug)]
pub(super) struct Dense {
    weights: Weights,
    /// `[n_outputs]`
    bias: Vec<f32>,
    n_inputs: usize,
}

impl Dense {
    pub(super) fn of(layer: &Linear) -> Self {
        let n_outputs = layer.bias.len().next_multiple_of(lanes());
        Self {
            weights: Weights::of(&padded_rows(layer, n_outputs), n_outputs),
            bias: padded(&layer.bias, n_outputs).collect(),
            n_inputs: layer.weight.n_rows(),
        }
    }

    /// Number of outputs, padding included.
    pub(super) fn n_outputs(&self) -> usize {
        self.bias.len()
    }

    /// `[n_rows][n_units]` to `[n_rows][n_outputs]`. A row has the same bits for any number of
    /// rows. Padding units of the input are ignored.
    #[inline(always)]
    pub(super) fn apply<S: Simd>(
        &self,
        simd: S,
        n_rows: usize,
        n_units: usize,
        inputs: &[f32],
        outputs: &mut [f32],
    ) {
        let outputs = &mut outputs[..n_rows * self.bias.len()];
        for output in outputs.chunks_exact_mut(self.bias.len()) {
            output.copy_from_slice(&self.bias);
        }
        let mut row = 0;
        if self.weights.is_narrow::<S>() {
            while row + NARROW_ROWS <= n_rows {
                self.add::<S, NARROW_ROWS>(simd, row, n_units, inputs, outputs);
                row += NARROW_ROWS;
            }
        }
        while row + ROWS <= n_rows {
            self.add::<S, ROWS>(simd, row, n_units, inputs, outputs);
            row += ROWS;
        }
        while row < n_rows {
            self.add::<S, 1>(simd, row, n_units, inputs, outputs);
            row += 1;
        }
    }

    /// Processes `N` rows from a first one on.
    #[inline(always)]
    fn add<S: Simd, const N: usize>(
        &self,
        simd: S,
        first: usize,
        n_units: usize,
        inputs: &[f32],
        outputs: &mut [f32],
    ) {
        let (mut factors, mut starts) = ([&inputs[..0]; N], [0; N]);
        for side in 0..N {
            factors[side] = &inputs[(first + side) * n_units..][..self.n_inputs];
            starts[side] = (first + side) * self.bias.len();
        }
        self.weights.add(simd, factors, starts, outputs);
    }
}

/// All weights of a layer, its rows padded with zeros.
pub(super) fn padded_rows(layer: &Linear, n: usize) -> Vec<f32> {
    layer.weight.rows().flat_map(|row| padded(row, n)).collect()
}

/// A row, padded with zeros.
pub(super) fn padded(row: &[f32], n: usize) -> impl Iterator<Item = f32> {
    row.iter().copied().chain(std::iter::repeat(0.0)).take(n)
}
