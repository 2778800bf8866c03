//! The learned parameters of a network.
//!
//! Every parameter of the physics is a change of a directly fitted value and starts at zero, and so
//! does the last layer of the perceptron. Training therefore begins at the physical model, and
//! weight decay regularizes towards it.

use std::collections::BTreeMap;

use rand::Rng;

use twintac_learn::{Linear, Matrix};

use super::{Physics, Variant};
use crate::features::Gains;
use crate::seed;

/// Largest magnitude of weights and biases in files.
const LARGEST: f32 = 1e6;
/// Largest magnitude of changes of ln gain in files.
const LARGEST_CHANGE: f32 = 50.0;

/// Above this, ln(1 + exp(x)) is x.
const SOFTPLUS_IS_LINEAR: f32 = 20.0;

/// Parameters of one variant. The type also holds a gradient with respect to them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Parameters {
    /// Change of ln gain; `[n_taxels]`.
    pub(crate) gain_change: Vec<f32>,
    /// Change of the overstress shares (memory), before the softplus that keeps them positive;
    /// `[n_time_constants][n_taxels]`, row by row.
    pub(crate) memory_change: Vec<f32>,
    /// The layers of the perceptron; empty in variants without one.
    pub(crate) layers: Vec<Linear>,
}

/// Plain weights by name: shape, and values row by row.
pub(crate) type Weights = BTreeMap<String, (Vec<usize>, Vec<f32>)>;

impl Parameters {
    /// Initial parameters, which do not change the physical model.
    pub(crate) fn new(physics: &Physics, hidden: &[usize], seed_number: u64) -> Self {
        let n_taxels = physics.n_taxels();
        let mut layers = Vec::new();
        if physics.variant.has_perceptron() {
            let widths = [&[n_taxels], hidden, &[n_taxels]].concat();
            let mut random = seed::stream(seed_number, &format!("weights/{}", physics.variant));
            for (layer, pair) in widths.windows(2).enumerate() {
                let last = layer + 2 == widths.len();
                // Uniform within ±1/√width.
                let reach = if last && physics.variant != Variant::Paper {
                    0.0
                } else {
                    (pair[0] as f32).sqrt().recip()
                };
                let mut draw = |count: usize| -> Vec<f32> {
                    (0..count)
                        .map(|_| reach * random.random_range(-1.0_f32..1.0))
                        .collect()
                };
                layers.push(Linear {
                    weight: Matrix {
                        values: draw(pair[0] * pair[1]),
                        n_columns: pair[1],
                    },
                    bias: draw(pair[1]),
                });
            }
        }
        Self {
            gain_change: vec![0.0; n_taxels],
            memory_change: vec![0.0; physics.n_time_constants() * n_taxels],
            layers,
        }
    }

    /// Zero for every parameter, to sum up a gradient.
    pub(crate) fn zeros_like(&self) -> Self {
        let zeros = |values: &[f32]| vec![0.0; values.len()];
        Self {
            gain_change: zeros(&self.gain_change),
            memory_change: zeros(&self.memory_change),
            layers: self
                .layers
                .iter()
                .map(|layer| Linear {
                    weight: Matrix::zeros(layer.weight.n_rows(), layer.weight.n_columns),
                    bias: zeros(&layer.bias),
                })
                .collect(),
        }
    }

    /// The arrays of numbers, in a fixed order.
    pub(crate) fn arrays(&self) -> impl Iterator<Item = &Vec<f32>> + Clone {
        let layers = self
            .layers
            .iter()
            .flat_map(|layer| [&layer.weight.values, &layer.bias]);
        [&self.gain_change, &self.memory_change].into_iter().chain(layers)
    }

    /// The arrays of numbers, in the order of [`Parameters::arrays`].
    pub(crate) fn arrays_mut(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        let layers = self
            .layers
            .iter_mut()
            .flat_map(|layer| [&mut layer.weight.values, &mut layer.bias]);
        [&mut self.gain_change, &mut self.memory_change]
            .into_iter()
            .chain(layers)
    }

    /// Widths of the hidden layers.
    pub(crate) fn hidden(&self) -> Vec<usize> {
        let widths = self.layers.iter().map(|layer| layer.bias.len());
        widths.take(self.layers.len().saturating_sub(1)).collect()
    }

    /// Share of each overstress in the reading, not negative; `[n_time_constants][n_taxels]`, row
    /// by row.
    pub(crate) fn memory(&self, physics: &Physics) -> Vec<f32> {
        let changed = physics.start_memory().into_iter().zip(&self.memory_change);
        changed.map(|(start, change)| softplus(start + change)).collect()
    }

    /// Gradient with respect to [`memory_change`](Self::memory_change), from the gradient with
    /// respect to [`Parameters::memory`].
    pub(crate) fn memory_gradient(&self, physics: &Physics, of_memory: &[f32]) -> Vec<f32> {
        let changed = physics.start_memory().into_iter().zip(&self.memory_change);
        changed
            .zip(of_memory)
            .map(|((start, change), of_memory)| softplus_backward(start + change, *of_memory))
            .collect()
    }

    /// The gains as learned.
    pub(crate) fn gains(&self, physics: &Physics) -> Gains {
        let memory = self.memory(physics);
        let n_taxels = physics.n_taxels();
        Gains {
            gain: physics
                .gains
                .gain
                .iter()
                .zip(&self.gain_change)
                .map(|(gain, change)| gain * f64::from(*change).exp())
                .collect(),
            stiffening_per_kpa: match physics.variant {
                Variant::Paper => vec![0.0; n_taxels],
                _ => physics.gains.stiffening_per_kpa.clone(),
            },
            memory: (0..n_taxels)
                .map(|k| {
                    let shares = memory.iter().skip(k).step_by(n_taxels);
                    shares.map(|share| f64::from(*share)).collect()
                })
                .collect(),
            time_constants_s: physics.gains.time_constants_s[..physics.n_time_constants()].to_vec(),
        }
    }

    /// The weights, by name.
    pub(crate) fn weights(&self) -> Weights {
        let n_taxels = self.gain_change.len();
        let n_constants = self.memory_change.len() / n_taxels.max(1);
        let mut weights = Weights::new();
        weights.insert("gain_change".into(), (vec![n_taxels], self.gain_change.clone()));
        weights.insert(
            "memory_change".into(),
            (vec![n_constants, n_taxels], self.memory_change.clone()),
        );
        for (index, layer) in self.layers.iter().enumerate() {
            let shape = vec![layer.weight.n_rows(), layer.weight.n_columns];
            weights.insert(
                format!("layer{index}.weight"),
                (shape, layer.weight.values.clone()),
            );
            weights.insert(
                format!("layer{index}.bias"),
                (vec![layer.bias.len()], layer.bias.clone()),
            );
        }
        weights
    }

    /// Parameters with given weights; the error says which do not fit.
    pub(crate) fn with_weights(
        physics: &Physics,
        hidden: &[usize],
        weights: &Weights,
    ) -> Result<Self, String> {
        let mut parameters = Self::new(physics, hidden, 0);
        let expected = parameters.weights();
        for (name, (shape, _)) in &expected {
            match weights.get(name) {
                Some((found, data)) if found == shape && data.len() == shape.iter().product::<usize>() => {
                    let largest = if name == "gain_change" {
                        LARGEST_CHANGE
                    } else {
                        LARGEST
                    };
                    let is_wrong = |number: &f32| !(-largest..=largest).contains(number);
                    if let Some(index) = data.iter().position(is_wrong) {
                        let found = data[index];
                        return Err(format!(
                            "`{name}[{index}]` is {found}, expected -{largest} to {largest}"
                        ));
                    }
                }
                Some((found, _)) => return Err(format!("`{name}` has shape {found:?}, expected {shape:?}")),
                None => return Err(format!("`{name}` is missing")),
            }
        }
        if let Some(name) = weights.keys().find(|name| !expected.contains_key(*name)) {
            return Err(format!("`{name}` is unknown"));
        }
        let numbers = |name: &str| weights[name].1.clone();
        parameters.gain_change = numbers("gain_change");
        parameters.memory_change = numbers("memory_change");
        for (index, layer) in parameters.layers.iter_mut().enumerate() {
            layer.weight.values = numbers(&format!("layer{index}.weight"));
            layer.bias = numbers(&format!("layer{index}.bias"));
        }
        Ok(parameters)
    }
}

/// ln(1 + exp(x))
fn softplus(x: f32) -> f32 {
    if x > SOFTPLUS_IS_LINEAR {
        x
    } else {
        x.exp().ln_1p()
    }
}

fn softplus_backward(x: f32, of_value: f32) -> f32 {
    if x > SOFTPLUS_IS_LINEAR {
        return of_value;
    }
    let exponential = x.exp();
    of_value * (1.0 / (exponential + 1.0)) * exponential
}
