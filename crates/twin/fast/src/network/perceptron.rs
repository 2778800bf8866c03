//! Linear layers with sigmoid linear units between them.

use twintac_learn::{Linear, Matrix};
use twintac_random::RandomStream;

use super::silu;

/// A perceptron, or a slope of each of its parameters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Perceptron {
    pub(crate) layers: Vec<Linear>,
}

/// What the way back needs.
pub(crate) struct Kept {
    /// What went into each layer.
    inputs: Vec<Matrix>,
    /// What came out of each layer but the last.
    outputs: Vec<Matrix>,
}

impl Perceptron {
    /// Random weights. `sizes` counts inputs, hidden units of each layer, and outputs.
    pub(crate) fn new(sizes: &[usize], random: &mut RandomStream) -> Self {
        let mut layers: Vec<Linear> = sizes
            .windows(2)
            .map(|pair| Linear::new(pair[0], pair[1], random))
            .collect();
        // A unit lets half of it through (He et al., arXiv 1502.01852).
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

    /// The same sizes, all zero.
    pub(crate) fn zeros(&self) -> Self {
        let mut zeros = self.clone();
        zeros.arrays_mut().for_each(|array| array.fill(0.0));
        zeros
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

    /// Adds the slopes of the parameters to `slopes`.
    pub(crate) fn backward(&self, kept: &Kept, output_slope: Matrix, slopes: &mut Self) {
        let mut slope = output_slope;
        for index in (1..self.layers.len()).rev() {
            slope = self.layers[index].backward(&kept.inputs[index], &slope, &mut slopes.layers[index]);
            silu::times_slope(&mut slope.values, &kept.outputs[index - 1].values);
        }
        // Nobody asks for the slope of the inputs.
        let first = &mut slopes.layers[0];
        twintac_learn::add(
            &mut first.weight.values,
            &kept.inputs[0].transposed_times(&slope).values,
        );
        twintac_learn::add(&mut first.bias, &slope.column_sums());
    }

    pub(crate) fn arrays(&self) -> impl Iterator<Item = &Vec<f32>> + Clone {
        self.layers.iter().flat_map(Linear::arrays)
    }

    pub(crate) fn arrays_mut(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        self.layers.iter_mut().flat_map(Linear::arrays_mut)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_those_of_differences() {
        let mut random = twintac_random::stream(1, "perceptron");
        let network = Perceptron::new(&[3, 5, 4, 2], &mut random);
        let input = Matrix {
            values: (0..12).map(|i| (f64::from(i) * 0.7).sin() as f32).collect(),
            n_columns: 3,
        };
        let loss = |network: &Perceptron| -> f32 {
            let (output, _) = network.forward(input.clone());
            output.values.iter().map(|value| value * value).sum()
        };
        let (output, kept) = network.forward(input.clone());
        let mut slopes = network.zeros();
        let slope = Matrix {
            values: output.values.iter().map(|value| 2.0 * value).collect(),
            n_columns: 2,
        };
        network.backward(&kept, slope, &mut slopes);
        let step = 1e-2;
        for (array, expected) in slopes.arrays().enumerate() {
            for index in 0..expected.len() {
                let [above, below] = [step, -step].map(|step| {
                    let mut moved = network.clone();
                    moved.arrays_mut().nth(array).unwrap()[index] += step;
                    loss(&moved)
                });
                let found = (above - below) / (2.0 * step);
                assert!(
                    (found - expected[index]).abs() < 2e-2,
                    "{found} {}",
                    expected[index]
                );
            }
        }
    }
}
