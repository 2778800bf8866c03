//! One encoder layer: attention, then a perceptron for each sample. Each acts on normalized values,
//! and its result is added to its input.

use twintac_learn::{Linear, Matrix, add};
use twintac_random::{RandomStream, normal};

use super::attention::{Attended, Attention};
use super::norm::{Norm, Normed};

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layer {
    before_attention: Norm,
    attention: Attention,
    before_perceptron: Norm,
    widen: Linear,
    narrow: Linear,
}

/// Values that the backward pass needs.
pub(super) struct Passed {
    first: Normed,
    attended: Attended,
    second: Normed,
    perceptron_input: Matrix,
    /// The hidden values of the perceptron, after its rectifier.
    hidden: Matrix,
}

impl Layer {
    pub(super) fn new(width: usize, n_heads: usize, hidden: usize, random: &mut RandomStream) -> Self {
        Self {
            before_attention: Norm::new(width),
            attention: Attention::new(width, n_heads, random),
            before_perceptron: Norm::new(width),
            widen: Linear::new(width, hidden, &mut |deviation| normal(random, deviation)),
            narrow: Linear::new(hidden, width, &mut |deviation| normal(random, deviation)),
        }
    }

    pub(super) fn forward(&self, mut values: Matrix) -> (Matrix, Passed) {
        let (normed, first) = self.before_attention.forward(&values);
        let (change, attended) = self.attention.forward(normed);
        add(&mut values.values, &change.values);
        let (perceptron_input, second) = self.before_perceptron.forward(&values);
        let mut hidden = self.widen.forward(&perceptron_input);
        hidden.values.iter_mut().for_each(|value| *value = value.max(0.0));
        add(&mut values.values, &self.narrow.forward(&hidden).values);
        let passed = Passed {
            first,
            attended,
            second,
            perceptron_input,
            hidden,
        };
        (values, passed)
    }

    pub(super) fn backward(&self, passed: &Passed, mut slope: Matrix, slopes: &mut Self) -> Matrix {
        let mut hidden_slope = self.narrow.backward(&passed.hidden, &slope, &mut slopes.narrow);
        for (slope, value) in hidden_slope.values.iter_mut().zip(&passed.hidden.values) {
            if *value <= 0.0 {
                *slope = 0.0;
            }
        }
        let input = &passed.perceptron_input;
        let normed = self.widen.backward(input, &hidden_slope, &mut slopes.widen);
        let own = &mut slopes.before_perceptron;
        add(
            &mut slope.values,
            &self
                .before_perceptron
                .backward(&passed.second, &normed, own)
                .values,
        );
        let normed = self
            .attention
            .backward(&passed.attended, &slope, &mut slopes.attention);
        let own = &mut slopes.before_attention;
        add(
            &mut slope.values,
            &self.before_attention.backward(&passed.first, &normed, own).values,
        );
        slope
    }

    pub(super) fn arrays(&self) -> impl Iterator<Item = &Vec<f32>> + Clone {
        let norms = [&self.before_attention, &self.before_perceptron];
        let linears = [&self.widen, &self.narrow];
        let simple = norms
            .into_iter()
            .flat_map(Norm::arrays)
            .chain(linears.into_iter().flat_map(Linear::arrays));
        self.attention.arrays().chain(simple)
    }

    pub(super) fn arrays_mut(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        let norms = [&mut self.before_attention, &mut self.before_perceptron];
        let linears = [&mut self.widen, &mut self.narrow];
        let norms = norms.into_iter().flat_map(Norm::arrays_mut);
        let simple = norms.chain(linears.into_iter().flat_map(Linear::arrays_mut));
        self.attention.arrays_mut().chain(simple)
    }
}
