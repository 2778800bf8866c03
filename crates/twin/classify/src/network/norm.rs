//! Layer normalization (Ba, Kiros and Hinton, arXiv 1607.06450).

use twintac_learn::{Matrix, add};

/// Keeps rows without variation finite.
const EPSILON: f32 = 1e-5;

/// Each row minus its mean, over its deviation, times a gain, plus an offset.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Norm {
    gain: Vec<f32>,
    bias: Vec<f32>,
}

/// Values that the backward pass needs.
pub(super) struct Normed {
    /// Rows of zero mean and unit deviation.
    unit: Matrix,
    /// One over the deviation of each row.
    per_deviation: Vec<f32>,
}

impl Norm {
    pub(super) fn new(width: usize) -> Self {
        Self {
            gain: vec![1.0; width],
            bias: vec![0.0; width],
        }
    }

    pub(super) fn forward(&self, input: &Matrix) -> (Matrix, Normed) {
        let (mut unit, mut output) = (input.clone(), input.clone());
        let n = input.n_columns as f32;
        let mut per_deviation = Vec::with_capacity(input.n_rows());
        for (row, to) in unit.rows_mut().zip(output.rows_mut()) {
            let mean = row.iter().sum::<f32>() / n;
            row.iter_mut().for_each(|value| *value -= mean);
            let variance = row.iter().map(|value| value * value).sum::<f32>() / n;
            let scale = (variance + EPSILON).sqrt().recip();
            row.iter_mut().for_each(|value| *value *= scale);
            per_deviation.push(scale);
            for ((to, value), (gain, bias)) in to.iter_mut().zip(row).zip(self.gain.iter().zip(&self.bias)) {
                *to = *value * gain + bias;
            }
        }
        (output, Normed { unit, per_deviation })
    }

    pub(super) fn backward(&self, normed: &Normed, output_slope: &Matrix, slopes: &mut Self) -> Matrix {
        let mut input_slope = output_slope.clone();
        let n = output_slope.n_columns as f32;
        add(&mut slopes.bias, &output_slope.column_sums());
        let rows = input_slope
            .rows_mut()
            .zip(normed.unit.rows())
            .zip(&normed.per_deviation);
        for ((row, unit), per_deviation) in rows {
            for ((sum, slope), unit) in slopes.gain.iter_mut().zip(row.iter()).zip(unit) {
                *sum += slope * unit;
            }
            row.iter_mut()
                .zip(&self.gain)
                .for_each(|(slope, gain)| *slope *= gain);
            let mean = row.iter().sum::<f32>() / n;
            let along = row
                .iter()
                .zip(unit)
                .map(|(slope, unit)| slope * unit)
                .sum::<f32>()
                / n;
            for (slope, unit) in row.iter_mut().zip(unit) {
                *slope = (*slope - mean - unit * along) * per_deviation;
            }
        }
        input_slope
    }

    pub(super) fn arrays(&self) -> [&Vec<f32>; 2] {
        [&self.gain, &self.bias]
    }

    pub(super) fn arrays_mut(&mut self) -> [&mut Vec<f32>; 2] {
        [&mut self.gain, &mut self.bias]
    }
}
