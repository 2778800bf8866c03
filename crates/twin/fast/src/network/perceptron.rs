//! Linear layers with rectifiers between them.

use serde::{Deserialize, Serialize};
use twintac_learn::{Linear, Matrix};
use twintac_random::RandomStream;

/// A perceptron, or a slope of each of its parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Perceptron {
    pub(crate) layers: Vec<Linear>,
}

/// What the way back needs: what went into each layer.
pub(crate) struct Kept(Vec<Matrix>);

impl Perceptron {
    /// Random weights. `sizes` counts inputs, hidden units of each layer, and outputs.
    pub(crate) fn new(sizes: &[usize], random: &mut RandomStream) -> Self {
        let mut layers: Vec<Linear> = sizes
            .windows(2)
            .map(|pair| Linear::new(pair[0], pair[1], random))
            .collect();
        // A rectifier lets half of it through (He et al., arXiv 1502.01852).
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
        let mut kept = Vec::with_capacity(self.layers.len());
        let mut values = input;
        for (index, layer) in self.layers.iter().enumerate() {
            if index > 0 {
                values.values.iter_mut().for_each(|value| *value = value.max(0.0));
            }
            let output = layer.forward(&values);
            kept.push(std::mem::replace(&mut values, output));
        }
        (values, Kept(kept))
    }

    /// Adds the slopes of the parameters to `slopes`.
    pub(crate) fn backward(&self, kept: &Kept, output_slope: Matrix, slopes: &mut Self) {
        let mut slope = output_slope;
        for (index, layer) in self.layers.iter().enumerate().rev() {
            let input = &kept.0[index];
            let into = &mut slopes.layers[index];
            if index == 0 {
                // Nobody asks for the slope of the inputs.
                twintac_learn::add(&mut into.weight.values, &input.transposed_times(&slope).values);
                twintac_learn::add(&mut into.bias, &slope.column_sums());
                return;
            }
            slope = layer.backward(input, &slope, into);
            for (slope, value) in slope.values.iter_mut().zip(&input.values) {
                if *value <= 0.0 {
                    *slope = 0.0;
                }
            }
        }
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
