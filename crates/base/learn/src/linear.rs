//! A linear map with an offset.

use crate::Matrix;

/// `y = x w + b`
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// `w`; `[n_inputs][n_outputs]`
    pub weight: Matrix,
    /// `b`; `[n_outputs]`
    pub bias: Vec<f32>,
}

impl Linear {
    /// Random weights that keep the size of what goes through, and no offset. `normal` gives numbers of the normal distribution about zero with the
    /// deviation that it is given.
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

    /// The outputs of each row of inputs. `[n][n_inputs]` to `[n][n_outputs]`
    #[must_use]
    pub fn forward(&self, input: &Matrix) -> Matrix {
        let mut output = input.times(&self.weight);
        self.add_bias(&mut output);
        output
    }

    /// The same into a matrix that is there.
    pub fn forward_into(&self, input: &Matrix, output: &mut Matrix) {
        input.times_into(&self.weight, output);
        self.add_bias(output);
    }

    fn add_bias(&self, sums: &mut Matrix) {
        for row in sums.rows_mut() {
            add(row, &self.bias);
        }
    }

    /// The slopes of the parameters.
    #[must_use]
    pub fn slopes(input: &Matrix, output_slope: &Matrix) -> Self {
        Self {
            weight: input.transposed_times(output_slope),
            bias: output_slope.column_sums(),
        }
    }

    /// The slope of the input.
    #[must_use]
    pub fn input_slope(&self, output_slope: &Matrix) -> Matrix {
        output_slope.times(&self.weight.transposed())
    }

    /// The slope of the input; adds those of the parameters to `slopes`.
    pub fn backward(&self, input: &Matrix, output_slope: &Matrix, slopes: &mut Self) -> Matrix {
        let own = Self::slopes(input, output_slope);
        add(&mut slopes.weight.values, &own.weight.values);
        add(&mut slopes.bias, &own.bias);
        self.input_slope(output_slope)
    }

    /// The parameters: weights, then offsets.
    #[must_use]
    pub fn arrays(&self) -> [&Vec<f32>; 2] {
        [&self.weight.values, &self.bias]
    }

    /// The same, to be changed.
    pub fn arrays_mut(&mut self) -> [&mut Vec<f32>; 2] {
        [&mut self.weight.values, &mut self.bias]
    }
}

/// Adds values to others, one by one.
pub fn add(to: &mut [f32], values: &[f32]) {
    to.iter_mut().zip(values).for_each(|(to, value)| *to += value);
}
