//! A multilayer perceptron with Gaussian error linear units (GELU) between its layers.

use std::f32::consts::{PI, SQRT_2};

use twintac_learn::{Linear, Matrix};

/// Values of a forward pass that a gradient needs.
pub(crate) struct PerceptronPass {
    /// Inputs of each layer; `[n_layers]`.
    inputs: Vec<Matrix>,
    /// Outputs of each layer but the last, before the activation; `[n_layers - 1]`.
    sums: Vec<Matrix>,
}

/// Outputs of the layers for each row of `inputs`, in the last of `rows`, which has one matrix for
/// each layer.
pub(crate) fn outputs<'a>(layers: &[Linear], inputs: &Matrix, rows: &'a mut [Matrix]) -> &'a mut Matrix {
    for (index, layer) in layers.iter().enumerate() {
        let (before, after) = rows.split_at_mut(index);
        if let Some(sums) = before.last_mut() {
            sums.values.iter_mut().for_each(|sum| *sum = gelu(*sum));
            layer.forward_into(sums, &mut after[0]);
        } else {
            layer.forward_into(inputs, &mut after[0]);
        }
    }
    &mut rows[layers.len() - 1]
}

/// Outputs of the layers for each row of `inputs`, with the values that a gradient needs.
pub(crate) fn forward(layers: &[Linear], inputs: &Matrix) -> (Matrix, PerceptronPass) {
    let mut pass = PerceptronPass {
        inputs: Vec::with_capacity(layers.len()),
        sums: Vec::with_capacity(layers.len()),
    };
    let mut rows = inputs.clone();
    for (index, layer) in layers.iter().enumerate() {
        let sums = layer.forward(&rows);
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

/// Gradients with respect to the layers' parameters, from the gradient with respect to the outputs.
pub(crate) fn gradient(layers: &[Linear], pass: &PerceptronPass, mut of_outputs: Matrix) -> Vec<Linear> {
    let mut gradients = Vec::with_capacity(layers.len());
    for (index, layer) in layers.iter().enumerate().rev() {
        gradients.push(Linear::slopes(&pass.inputs[index], &of_outputs));
        if index > 0 {
            let mut of_sums = layer.input_slope(&of_outputs);
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
