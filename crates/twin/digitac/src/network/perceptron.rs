//! A multilayer perceptron with Gaussian error linear units (GELU) between its layers.

use std::f32::consts::{PI, SQRT_2};

use twintac_learn::Matrix;

/// A layer: rows × weight + bias. Also holds the gradient of one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layer {
    /// `[n_inputs][n_outputs]`
    pub(crate) weight: Matrix,
    /// `[n_outputs]`
    pub(crate) bias: Vec<f32>,
}

/// What a gradient needs of a forward pass.
pub(crate) struct PerceptronPass {
    /// Inputs of each layer; `[n_layers]`.
    inputs: Vec<Matrix>,
    /// Outputs of each layer but the last, before the activation; `[n_layers - 1]`.
    sums: Vec<Matrix>,
}

impl Layer {
    fn add_bias(&self, sums: &mut Matrix) {
        for row in sums.rows_mut() {
            row.iter_mut()
                .zip(&self.bias)
                .for_each(|(sum, bias)| *sum += bias);
        }
    }
}

/// Outputs of the layers for each row of `inputs`, in the last of `rows`, which there is one of for each layer.
pub(crate) fn outputs<'a>(layers: &[Layer], inputs: &Matrix, rows: &'a mut [Matrix]) -> &'a mut Matrix {
    for (index, layer) in layers.iter().enumerate() {
        let (before, after) = rows.split_at_mut(index);
        if let Some(sums) = before.last_mut() {
            sums.values.iter_mut().for_each(|sum| *sum = gelu(*sum));
            sums.times_into(&layer.weight, &mut after[0]);
        } else {
            inputs.times_into(&layer.weight, &mut after[0]);
        }
        layer.add_bias(&mut after[0]);
    }
    &mut rows[layers.len() - 1]
}

/// Outputs of the layers for each row of `inputs`, with what a gradient needs.
pub(crate) fn forward(layers: &[Layer], inputs: &Matrix) -> (Matrix, PerceptronPass) {
    let mut pass = PerceptronPass {
        inputs: Vec::with_capacity(layers.len()),
        sums: Vec::with_capacity(layers.len()),
    };
    let mut rows = inputs.clone();
    for (index, layer) in layers.iter().enumerate() {
        let mut sums = rows.times(&layer.weight);
        layer.add_bias(&mut sums);
        pass.inputs.push(rows);
        if index + 1 == layers.len() {
            return (sums, pass);
        }
        rows = Matrix {
            values: sums.values.iter().map(|sum| gelu(*sum)).collect(),
            n_columns: sums.n_columns,
        };
        pass.sums.push(sums);
    }
    (rows, pass)
}

/// Gradients of the layers' parameters, from the gradient of the outputs.
pub(crate) fn gradient(layers: &[Layer], pass: &PerceptronPass, mut of_outputs: Matrix) -> Vec<Layer> {
    let mut gradients = Vec::with_capacity(layers.len());
    for (index, layer) in layers.iter().enumerate().rev() {
        gradients.push(Layer {
            weight: pass.inputs[index].transposed_times(&of_outputs),
            bias: of_outputs.column_sums(),
        });
        if index > 0 {
            let mut of_sums = of_outputs.times(&layer.weight.transposed());
            for (slope, sum) in of_sums.values.iter_mut().zip(&pass.sums[index - 1].values) {
                *slope *= gelu_slope(*sum);
            }
            of_outputs = of_sums;
        }
    }
    gradients.reverse();
    gradients
}

/// x Φ(x), with Φ the normal distribution (Hendrycks and Gimpel, arXiv 1606.08415).
fn gelu(x: f32) -> f32 {
    0.5 * x * (1.0 + libm::erff(x / SQRT_2))
}

fn gelu_slope(x: f32) -> f32 {
    let distribution = 0.5 * (1.0 + libm::erff(x / SQRT_2));
    let density = (1.0 / (2.0 * PI).sqrt()) * (-0.5 * x * x).exp();
    distribution + x * density
}
