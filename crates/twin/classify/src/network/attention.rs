//! Attention of each sample of a series to all of them, in several heads (Vaswani et al., arXiv
//! 1706.03762, section 3.2).

use twintac_learn::{Linear, Matrix};
use twintac_random::{RandomStream, normal};

use crate::series::N_SAMPLES;

/// Linear layers for queries, keys and values, and for the output of the heads.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Attention {
    n_heads: usize,
    query: Linear,
    key: Linear,
    value: Linear,
    leave: Linear,
}

/// Values that the backward pass needs.
pub(super) struct Attended {
    input: Matrix,
    query: Matrix,
    key: Matrix,
    value: Matrix,
    /// Attention weights of each series and head; `[n_series * n_heads][N_SAMPLES][N_SAMPLES]`.
    shares: Vec<Matrix>,
    heads: Matrix,
}

impl Attention {
    pub(super) fn new(width: usize, n_heads: usize, random: &mut RandomStream) -> Self {
        let mut linear = || Linear::new(width, width, &mut |deviation| normal(random, deviation));
        Self {
            n_heads,
            query: linear(),
            key: linear(),
            value: linear(),
            leave: linear(),
        }
    }

    /// `input` has one series after another; `[n_series * N_SAMPLES][width]`.
    pub(super) fn forward(&self, input: Matrix) -> (Matrix, Attended) {
        let query = self.query.forward(&input);
        let key = self.key.forward(&input);
        let value = self.value.forward(&input);
        let mut heads = Matrix::zeros(input.n_rows(), input.n_columns);
        let mut shares = Vec::new();
        let scale = self.scale(&input);
        for block in self.blocks(&input) {
            let mut share = block.of(&query).times(&block.of(&key).transposed());
            for row in share.rows_mut() {
                softmax(row, scale);
            }
            block.put(&share.times(&block.of(&value)), &mut heads);
            shares.push(share);
        }
        let output = self.leave.forward(&heads);
        let attended = Attended {
            input,
            query,
            key,
            value,
            shares,
            heads,
        };
        (output, attended)
    }

    pub(super) fn backward(&self, attended: &Attended, output_slope: &Matrix, slopes: &mut Self) -> Matrix {
        let Attended { input, .. } = attended;
        let heads_slope = self
            .leave
            .backward(&attended.heads, output_slope, &mut slopes.leave);
        let zeros = || Matrix::zeros(input.n_rows(), input.n_columns);
        let (mut query_slope, mut key_slope, mut value_slope) = (zeros(), zeros(), zeros());
        let scale = self.scale(input);
        for (block, share) in self.blocks(input).zip(&attended.shares) {
            let head_slope = block.of(&heads_slope);
            block.put(&share.transposed_times(&head_slope), &mut value_slope);
            let mut score_slope = head_slope.times(&block.of(&attended.value).transposed());
            for (row, share) in score_slope.rows_mut().zip(share.rows()) {
                let mean: f32 = row.iter().zip(share).map(|(slope, share)| slope * share).sum();
                row.iter_mut()
                    .zip(share)
                    .for_each(|(slope, share)| *slope = (*slope - mean) * share * scale);
            }
            block.put(&score_slope.times(&block.of(&attended.key)), &mut query_slope);
            block.put(
                &score_slope.transposed_times(&block.of(&attended.query)),
                &mut key_slope,
            );
        }
        let mut input_slope = self.query.backward(input, &query_slope, &mut slopes.query);
        for (linear, slope, own) in [
            (&self.key, &key_slope, &mut slopes.key),
            (&self.value, &value_slope, &mut slopes.value),
        ] {
            twintac_learn::add(
                &mut input_slope.values,
                &linear.backward(input, slope, own).values,
            );
        }
        input_slope
    }

    fn scale(&self, input: &Matrix) -> f32 {
        ((input.n_columns / self.n_heads) as f32).sqrt().recip()
    }

    /// The parts of a matrix of all series that each belong to one series and one head.
    fn blocks(&self, input: &Matrix) -> impl Iterator<Item = Block> + use<> {
        let (n_heads, width) = (self.n_heads, input.n_columns / self.n_heads);
        let series = 0..input.n_rows() / N_SAMPLES;
        series.flat_map(move |series| {
            (0..n_heads).map(move |head| Block {
                first_row: series * N_SAMPLES,
                first_column: head * width,
                width,
            })
        })
    }

    pub(super) fn arrays(&self) -> impl Iterator<Item = &Vec<f32>> + Clone {
        [&self.query, &self.key, &self.value, &self.leave]
            .into_iter()
            .flat_map(Linear::arrays)
    }

    pub(super) fn arrays_mut(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        [&mut self.query, &mut self.key, &mut self.value, &mut self.leave]
            .into_iter()
            .flat_map(Linear::arrays_mut)
    }
}

/// Softmax of a row of scores, scaled first.
fn softmax(row: &mut [f32], scale: f32) {
    let largest = row.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    row.iter_mut()
        .for_each(|score| *score = ((*score - largest) * scale).exp());
    let sum: f32 = row.iter().sum();
    row.iter_mut().for_each(|share| *share /= sum);
}

/// Rows of one series and columns of one head.
struct Block {
    first_row: usize,
    first_column: usize,
    width: usize,
}

impl Block {
    fn of(&self, matrix: &Matrix) -> Matrix {
        let rows = matrix.rows().skip(self.first_row).take(N_SAMPLES);
        let values = rows.flat_map(|row| &row[self.first_column..self.first_column + self.width]);
        Matrix {
            values: values.copied().collect(),
            n_columns: self.width,
        }
    }

    fn put(&self, values: &Matrix, to: &mut Matrix) {
        let rows = to.rows_mut().skip(self.first_row).take(N_SAMPLES);
        for (to, row) in rows.zip(values.rows()) {
            to[self.first_column..self.first_column + self.width].copy_from_slice(row);
        }
    }
}
