//! A network that computes features of each point by itself before it combines all points: whether
//! a point is in contact depends on that point alone.

use twintac_learn::{Linear, Matrix, add};
use twintac_random::{RandomStream, normal};

use super::perceptron::{Kept, Perceptron};
use super::silu;
use crate::contact::N_CHANNELS;

/// The network, or the gradient of its parameters. Its inputs are the channels of each point, then
/// the other inputs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LocalNetwork {
    /// From the channels of a point to its features, the same for every point. A feature is the
    /// activation minus the activation of a point that nothing is near.
    pub(crate) point: Linear,
    /// From the features of all points and the other inputs to the outputs.
    pub(crate) rest: Perceptron,
}

/// Values that the backward pass needs.
pub(crate) struct LocalKept {
    /// `[n_rows * n_points][N_CHANNELS]`
    points: Matrix,
    /// `[n_rows * n_points][n_features]`
    before_unit: Matrix,
    rest: Kept,
}

impl LocalNetwork {
    /// Random weights for these numbers of points, features and other inputs.
    pub(crate) fn new(
        [n_points, n_features, n_others]: [usize; 3],
        hidden: &[usize],
        n_outputs: usize,
        random: &mut RandomStream,
    ) -> Self {
        let mut sizes = vec![n_points * n_features + n_others];
        sizes.extend(hidden);
        sizes.push(n_outputs);
        Self {
            point: Linear::new(N_CHANNELS, n_features, &mut |deviation| normal(random, deviation)),
            rest: Perceptron::new(&sizes, random),
        }
    }

    /// The same sizes, all zero.
    pub(crate) fn zeros(&self) -> Self {
        let mut zeros = self.clone();
        zeros.arrays_mut().for_each(|array| array.fill(0.0));
        zeros
    }

    /// Activations of a point that nothing is near, which are subtracted.
    pub(crate) fn nothing(&self) -> Vec<f32> {
        let mut nothing = self.point.bias.clone();
        silu::apply(&mut nothing);
        nothing
    }

    /// Outputs of each row of inputs. `[n_rows][n_points * N_CHANNELS + n_others]`
    pub(crate) fn forward(&self, input: &Matrix, n_points: usize) -> (Matrix, LocalKept) {
        let n_of_points = n_points * N_CHANNELS;
        let mut points = Matrix::zeros(0, N_CHANNELS);
        for row in input.rows() {
            points.values.extend_from_slice(&row[..n_of_points]);
        }
        let before_unit = self.point.forward(&points);
        let mut features = before_unit.clone();
        silu::apply(&mut features.values);
        let nothing = self.nothing();
        for row in features.rows_mut() {
            row.iter_mut()
                .zip(&nothing)
                .for_each(|(feature, nothing)| *feature -= nothing);
        }
        let n_features = n_points * nothing.len();
        let n_others = input.n_columns - n_of_points;
        let mut joined = Matrix::zeros(0, n_features + n_others);
        joined.values.reserve(input.n_rows() * joined.n_columns);
        for (features, row) in features.values.chunks_exact(n_features).zip(input.rows()) {
            joined.values.extend_from_slice(features);
            joined.values.extend_from_slice(&row[n_of_points..]);
        }
        let (output, rest) = self.rest.forward(joined);
        let kept = LocalKept {
            points,
            before_unit,
            rest,
        };
        (output, kept)
    }

    /// Adds the gradient of the parameters to `slopes`.
    pub(crate) fn backward(
        &self,
        kept: &LocalKept,
        output_slope: Matrix,
        n_points: usize,
        slopes: &mut Self,
    ) {
        let joined = self.rest.backward(&kept.rest, output_slope, &mut slopes.rest);
        let n_features = self.point.bias.len();
        let mut slope = Matrix::zeros(0, n_features);
        for row in joined.rows() {
            slope.values.extend_from_slice(&row[..n_points * n_features]);
        }
        // The subtracted activation depends on the bias alone.
        let mut taken_off = slope.column_sums();
        silu::times_slope(&mut taken_off, &self.point.bias);
        silu::times_slope(&mut slope.values, &kept.before_unit.values);
        add(
            &mut slopes.point.weight.values,
            &kept.points.transposed_times(&slope).values,
        );
        add(&mut slopes.point.bias, &slope.column_sums());
        slopes
            .point
            .bias
            .iter_mut()
            .zip(taken_off)
            .for_each(|(bias, off)| *bias -= off);
    }

    pub(crate) fn arrays(&self) -> impl Iterator<Item = &Vec<f32>> + Clone {
        self.point.arrays().into_iter().chain(self.rest.arrays())
    }

    pub(crate) fn arrays_mut(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        self.point.arrays_mut().into_iter().chain(self.rest.arrays_mut())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_those_of_differences() {
        const N_POINTS: usize = 4;
        let mut random = twintac_random::stream(1, "local network");
        let mut network = LocalNetwork::new([N_POINTS, 2, 3], &[5, 4], 2, &mut random);
        network
            .arrays_mut()
            .flatten()
            .for_each(|value| *value += normal(&mut random, 0.1) as f32);
        let input = Matrix {
            values: (0..3 * (N_POINTS * N_CHANNELS + 3))
                .map(|i| (i as f64 * 0.7).sin() as f32)
                .collect(),
            n_columns: N_POINTS * N_CHANNELS + 3,
        };
        let loss = |network: &LocalNetwork| -> f64 {
            let (output, _) = network.forward(&input, N_POINTS);
            output.values.iter().map(|value| f64::from(value * value)).sum()
        };
        let (output, kept) = network.forward(&input, N_POINTS);
        let mut slopes = network.zeros();
        let slope = Matrix {
            values: output.values.iter().map(|value| 2.0 * value).collect(),
            n_columns: 2,
        };
        network.backward(&kept, slope, N_POINTS, &mut slopes);
        let step = 5e-3;
        for (array, expected) in slopes.arrays().enumerate() {
            for index in 0..expected.len() {
                let [above, below] = [step, -step].map(|step| {
                    let mut moved = network.clone();
                    moved.arrays_mut().nth(array).unwrap()[index] += step;
                    loss(&moved)
                });
                let found = (above - below) / f64::from(2.0 * step);
                let expected = f64::from(expected[index]);
                assert!(
                    (found - expected).abs() < 1e-3 + 1e-2 * expected.abs(),
                    "{array} {index}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn points_near_which_nothing_is_have_no_features() {
        let mut random = twintac_random::stream(1, "local network");
        let network = LocalNetwork::new([2, 3, 1], &[4], 1, &mut random);
        let mut input = Matrix::zeros(1, 2 * N_CHANNELS + 1);
        input.values[2 * N_CHANNELS] = 0.5;
        let (found, _) = network.forward(&input, 2);
        let mut alone = Matrix::zeros(1, 7);
        alone.values[6] = 0.5;
        assert_eq!(network.rest.forward(alone).0, found);
    }
}
