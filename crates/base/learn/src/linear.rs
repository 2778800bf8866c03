//! A linear layer.

use crate::Matrix;

/// A linear layer, `y = x w + b`.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// Weights `w`; `[n_inputs][n_outputs]`.
    pub weight: Matrix,
    /// Bias `b`; `[n_outputs]`.
    pub bias: Vec<f32>,
}

impl Linear {
    /// Random weights with a standard deviation of `1 / √n_inputs`, so that outputs are about as
    /// large as inputs, and a bias of zero. `normal` draws a normally distributed number with mean
    /// zero and the standard deviation that it is given.
    #[must_use]
    pub fn new(n_inputs: usize, n_outputs: usize, normal: &mut dyn FnMut(f64) -> f64) -> Self {
        let mut weight = Matrix::zeros(n_inputs, n_outputs);
        let deviation = (n_inputs as f64).sqrt().recip();
        for value in &mut weight.values {
            *value = normal(deviation) as f32;
        }
        Self {
            weight,
            bias: vec![0.0; n_outputs],
        }
    }

    /// Outputs for each row of inputs; from `[n][n_inputs]` to `[n][n_outputs]`.
    #[must_use]
    pub fn forward(&self, input: &Matrix) -> Matrix {
        let mut output = input.times(&self.weight);
        self.add_bias(&mut output);
        output
    }

    /// Like [`forward`](Self::forward), but writes the outputs into an existing matrix.
    pub fn forward_into(&self, input: &Matrix, output: &mut Matrix) {
        input.times_into(&self.weight, output);
        self.add_bias(output);
    }

    fn add_bias(&self, sums: &mut Matrix) {
        for row in sums.rows_mut() {
            add(row, &self.bias);
        }
    }

    /// Gradients of the parameters, from the inputs `[n][n_inputs]` and the gradients of the
    /// outputs `[n][n_outputs]`.
    #[must_use]
    pub fn slopes(input: &Matrix, output_slope: &Matrix) -> Self {
        Self {
            weight: input.transposed_times(output_slope),
            bias: output_slope.column_sums(),
        }
    }

    /// Gradients of the inputs, `[n][n_inputs]`, from those of the outputs.
    #[must_use]
    pub fn input_slope(&self, output_slope: &Matrix) -> Matrix {
        output_slope.times(&self.weight.transposed())
    }

    /// Returns the gradients of the inputs, and adds those of the parameters to `slopes`.
    pub fn backward(&self, input: &Matrix, output_slope: &Matrix, slopes: &mut Self) -> Matrix {
        let own = Self::slopes(input, output_slope);
        add(&mut slopes.weight.values, &own.weight.values);
        add(&mut slopes.bias, &own.bias);
        self.input_slope(output_slope)
    }

    /// The parameters: weights, then bias.
    #[must_use]
    pub fn arrays(&self) -> [&Vec<f32>; 2] {
        [&self.weight.values, &self.bias]
    }

    /// The parameters, mutable: weights, then bias.
    pub fn arrays_mut(&mut self) -> [&mut Vec<f32>; 2] {
        [&mut self.weight.values, &mut self.bias]
    }
}

/// Adds `values` to `to`, element by element.
pub fn add(to: &mut [f32], values: &[f32]) {
    to.iter_mut().zip(values).for_each(|(to, value)| *to += value);
}
