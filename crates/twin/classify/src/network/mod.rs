//! The network: an encoder of a series, and a classification from the encoded samples together.

mod attention;
mod layer;
mod norm;

use twintac_learn::{Linear, Matrix, add};
use twintac_random::{RandomStream, normal};

use crate::TrainSettings;
use crate::series::N_SAMPLES;
use layer::Layer;
use norm::Norm;

/// Standard deviation of the initial position embeddings.
const PLACE: f64 = 0.02;

/// All parameters, or the gradient of each.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Network {
    enter: Linear,
    /// Position embeddings, added to each sample's token; `[N_SAMPLES * width]`.
    places: Vec<f32>,
    layers: Vec<Layer>,
    norm: Norm,
    leave: Linear,
}

impl Network {
    pub(crate) fn new(
        n_inputs: usize,
        n_classes: usize,
        settings: &TrainSettings,
        random: &mut RandomStream,
    ) -> Self {
        let width = settings.width;
        let enter = Linear::new(n_inputs, width, &mut |deviation| normal(random, deviation));
        let mut place = || normal(random, PLACE) as f32;
        let places = (0..N_SAMPLES * width).map(|_| place()).collect();
        let layer = |_| Layer::new(width, settings.n_heads, settings.hidden, random);
        let layers = (0..settings.n_layers).map(layer).collect();
        Self {
            enter,
            places,
            layers,
            norm: Norm::new(width),
            leave: Linear::new(N_SAMPLES * width, n_classes, &mut |deviation| {
                normal(random, deviation)
            }),
        }
    }

    /// Scores of each class; `[n_series][n_classes]`. `input` has one series after another;
    /// `[n_series * N_SAMPLES][n_inputs]`.
    pub(crate) fn scores(&self, input: &Matrix) -> Matrix {
        let mut tokens = self.tokens(input);
        for layer in &self.layers {
            tokens = layer.forward(tokens).0;
        }
        self.leave.forward(&whole(self.norm.forward(&tokens).0))
    }

    /// Mean cross-entropy of the true classes, and its gradient.
    pub(crate) fn loss_and_slopes(&self, input: &Matrix, classes: &[usize]) -> (f32, Self) {
        let mut slopes = self.zeros();
        let mut tokens = self.tokens(input);
        let mut passed = Vec::with_capacity(self.layers.len());
        for layer in &self.layers {
            let (next, of_layer) = layer.forward(tokens);
            tokens = next;
            passed.push(of_layer);
        }
        let (normed, of_norm) = self.norm.forward(&tokens);
        let width = normed.n_columns;
        let last = whole(normed);
        let (loss, score_slopes) = cross_entropy(self.leave.forward(&last), classes);
        let mut slope = self.leave.backward(&last, &score_slopes, &mut slopes.leave);
        slope.n_columns = width;
        slope = self.norm.backward(&of_norm, &slope, &mut slopes.norm);
        let layers = self.layers.iter().zip(&passed).zip(&mut slopes.layers);
        for ((layer, passed), own) in layers.rev() {
            slope = layer.backward(passed, slope, own);
        }
        for series in slope.values.chunks_exact(self.places.len()) {
            add(&mut slopes.places, series);
        }
        self.enter.backward(input, &slope, &mut slopes.enter);
        (loss, slopes)
    }

    fn tokens(&self, input: &Matrix) -> Matrix {
        let mut tokens = self.enter.forward(input);
        for series in tokens.values.chunks_exact_mut(self.places.len()) {
            add(series, &self.places);
        }
        tokens
    }

    fn zeros(&self) -> Self {
        let mut zeros = self.clone();
        zeros.arrays_mut().for_each(|array| array.fill(0.0));
        zeros
    }

    /// All parameters.
    pub(crate) fn arrays(&self) -> impl Iterator<Item = &Vec<f32>> + Clone {
        let simple = self.enter.arrays().into_iter().chain([&self.places]);
        let last = self.norm.arrays().into_iter().chain(self.leave.arrays());
        simple
            .chain(self.layers.iter().flat_map(Layer::arrays))
            .chain(last)
    }

    /// All parameters in the same order, mutable.
    pub(crate) fn arrays_mut(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        let simple = self.enter.arrays_mut().into_iter().chain([&mut self.places]);
        let last = self.norm.arrays_mut().into_iter().chain(self.leave.arrays_mut());
        simple
            .chain(self.layers.iter_mut().flat_map(Layer::arrays_mut))
            .chain(last)
    }
}

/// Reshapes the tokens to one row for each series.
fn whole(mut tokens: Matrix) -> Matrix {
    tokens.n_columns *= N_SAMPLES;
    tokens
}

/// Converts scores to probabilities.
pub(crate) fn softmax(scores: &mut [f32]) {
    let largest = scores.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    scores
        .iter_mut()
        .for_each(|score| *score = (*score - largest).exp());
    let sum: f32 = scores.iter().sum();
    scores.iter_mut().for_each(|score| *score /= sum);
}

/// Mean negative logarithm of the true classes' probabilities, and its gradient with respect to the
/// scores.
fn cross_entropy(mut scores: Matrix, classes: &[usize]) -> (f32, Matrix) {
    let per_series = (classes.len() as f32).recip();
    let mut loss = 0.0;
    for (row, class) in scores.rows_mut().zip(classes) {
        softmax(row);
        loss -= row[*class].max(f32::MIN_POSITIVE).ln() * per_series;
        row.iter_mut().for_each(|share| *share *= per_series);
        row[*class] -= per_series;
    }
    (loss, scores)
}

#[cfg(test)]
mod tests {
    use super::*;
    use twintac_random::stream;

    /// Compares the gradients of all parameters of a small network with difference quotients.
    #[test]
    fn slopes_are_those_of_differences() {
        let settings = TrainSettings {
            width: 4,
            n_layers: 2,
            n_heads: 2,
            hidden: 5,
            ..TrainSettings::default()
        };
        let mut random = stream(3, "network");
        let mut network = Network::new(3, 3, &settings, &mut random);
        for array in network.arrays_mut() {
            for value in array.iter_mut() {
                *value += normal(&mut random, 0.1) as f32;
            }
        }
        let mut input = Matrix::zeros(2 * N_SAMPLES, 3);
        for value in &mut input.values {
            *value = normal(&mut random, 1.0) as f32;
        }
        let classes = [2, 0];
        let (loss, slopes) = network.loss_and_slopes(&input, &classes);
        assert!((loss - cross_entropy(network.scores(&input), &classes).0).abs() < 1e-6);
        let step = 1e-3_f32;
        let (mut n_checked, mut worst) = (0, 0.0_f32);
        for (index, slope) in slopes.arrays().enumerate() {
            for place in (0..slope.len()).step_by(slope.len().div_ceil(12)) {
                let moved = |by: f32| {
                    let mut moved = network.clone();
                    moved.arrays_mut().nth(index).unwrap()[place] += by;
                    cross_entropy(moved.scores(&input), &classes).0
                };
                let expected = (moved(step) - moved(-step)) / (2.0 * step);
                worst = worst.max((expected - slope[place]).abs() / (0.02 + expected.abs()));
                n_checked += 1;
            }
        }
        assert!(n_checked > 150 && worst < 0.05, "{worst} in {n_checked}");
    }
}
