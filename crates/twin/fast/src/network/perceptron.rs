//! Linear layers with sigmoid linear units between them.

use twintac_learn::{Linear, Matrix};
use twintac_random::{RandomStream, normal};

use super::silu;

/// A multilayer perceptron, or the gradient of its parameters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Perceptron {
    pub(crate) layers: Vec<Linear>,
}

/// Values that the backward pass needs.
pub(crate) struct Kept {
    /// Inputs of each layer.
    inputs: Vec<Matrix>,
    /// Outputs of each layer but the last.
    outputs: Vec<Matrix>,
}

impl Perceptron {
    /// Random weights. `sizes`: numbers of inputs, of hidden units of each layer, and of outputs.
    pub(crate) fn new(sizes: &[usize], random: &mut RandomStream) -> Self {
        let mut layers: Vec<Linear> = sizes
            .windows(2)
            .map(|pair| Linear::new(pair[0], pair[1], &mut |deviation| normal(random, deviation)))
            .collect();
        // Compensates that a unit passes about half of its inputs (He et al., arXiv 1502.01852).
        let last = layers.len() - 1;
        for layer in &mut layers[..last] {
            layer
                .weight
                .values
                .iter_mut()
                .for_each(|weight| *weight *= std::f32::consts::SQRT_2);
        }
        Self { layers }
    }

    /// Outputs of each row of inputs.
    pub(crate) fn forward(&self, input: Matrix) -> (Matrix, Kept) {
        let mut kept = Kept {
            inputs: Vec::new(),
            outputs: Vec::new(),
        };
        let mut output = self.layers[0].forward(&input);
        kept.inputs.push(input);
        for layer in &self.layers[1..] {
            let mut input = output.clone();
            silu::apply(&mut input.values);
            kept.outputs
                .push(std::mem::replace(&mut output, layer.forward(&input)));
            kept.inputs.push(input);
        }
        (output, kept)
    }

    /// Returns the gradient of the inputs; adds that of the parameters to `slopes`.
    pub(crate) fn backward(&self, kept: &Kept, output_slope: Matrix, slopes: &mut Self) -> Matrix {
        let mut slope = output_slope;
        for index in (1..self.layers.len()).rev() {
            slope = self.layers[index].backward(&kept.inputs[index], &slope, &mut slopes.layers[index]);
            silu::times_slope(&mut slope.values, &kept.outputs[index - 1].values);
        }
        self.layers[0].backward(&kept.inputs[0], &slope, &mut slopes.layers[0])
    }

    pub(crate) fn arrays(&self) -> impl Iterator<Item = &Vec<f32>> + Clone {
        self.layers.iter().flat_map(Linear::arrays)
    }

    pub(crate) fn arrays_mut(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        self.layers.iter_mut().flat_map(Linear::arrays_mut)
    }
}
