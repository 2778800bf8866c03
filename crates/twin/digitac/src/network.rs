//! The learned part of a twin, on burn.
//!
//! Every parameter of the physics is a change to what was fitted directly and starts at zero, and so does the
//! last layer of the perceptron: training begins at the physical model, and weight decay pulls back to it.

use std::collections::BTreeMap;

use burn::module::{Module, Param};
use burn::nn::Linear;
use burn::tensor::{Device, Tensor, TensorData, activation};
use rand::Rng;

use crate::gains::Gains;
use crate::normalization::Normalization;
use crate::{Features, Variant, seed};

/// Below this share of the largest reading, squared, the size of a frame's readings is rounded off to keep
/// its slope finite.
const ROUNDING: f64 = 1e-8;
/// Memory shares below this start here: from zero nothing could be learned.
const SMALLEST_MEMORY: f64 = 1e-3;

/// Parameters of one variant.
#[derive(Module, Debug)]
pub(crate) struct Network {
    /// Change of ln gain; `[n_taxels]`.
    gain_change: Param<Tensor<1>>,
    /// Change of memory, before the softplus that keeps it positive; `[n_time_constants, n_taxels]`.
    memory_change: Param<Tensor<2>>,
    /// The perceptron; none in variants without.
    layers: Vec<Linear>,
}

/// What a variant is built from and does not learn.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Physics {
    pub(crate) variant: Variant,
    pub(crate) gains: Gains,
    pub(crate) normalization: Normalization,
    /// Largest correction over the size of the frame's readings.
    pub(crate) correction_limit: f64,
}

/// Plain weights: shape and numbers, row by row.
pub(crate) type Weights = BTreeMap<String, (Vec<usize>, Vec<f32>)>;

impl Physics {
    /// Input rows of the variant, of order one; `[n_frames * n_taxels]`.
    pub(crate) fn inputs(&self, features: &Features) -> Vec<f32> {
        let n = &self.normalization;
        match self.variant {
            Variant::Paper => features
                .stress_kpa_per_mm
                .iter()
                .flat_map(|row| {
                    let scales = n
                        .stress_mean_kpa_per_mm
                        .iter()
                        .zip(&n.stress_deviation_kpa_per_mm);
                    row.iter()
                        .zip(scales)
                        .map(|(s, (mean, deviation))| ((s - mean) / deviation) as f32)
                })
                .collect(),
            _ => features
                .pressure_kpa
                .iter()
                .flat_map(|row| {
                    row.iter()
                        .zip(&n.pressure_rms_kpa)
                        .map(|(p, rms)| (p / rms) as f32)
                })
                .collect(),
        }
    }

    pub(crate) fn n_taxels(&self) -> usize {
        self.gains.gain.len()
    }

    pub(crate) fn n_time_constants(&self) -> usize {
        if self.variant.has_memory() {
            self.gains.time_constants_s.len()
        } else {
            0
        }
    }

    /// Readings of order one over inputs of order one, without what is learned; `[n_taxels]`.
    fn start_gains(&self, device: &Device) -> Tensor<1> {
        let n = &self.normalization;
        let gains = self.gains.gain.iter().zip(&n.pressure_rms_kpa);
        vector(
            gains
                .map(|(gain, rms)| (gain * rms / n.reading_kpa) as f32)
                .collect(),
            device,
        )
    }

    /// Memory before the softplus; `[n_time_constants, n_taxels]`.
    fn start_memory(&self, device: &Device) -> Tensor<2> {
        let inverse_softplus = |share: f64| share.max(SMALLEST_MEMORY).exp_m1().ln();
        let numbers: Vec<f32> = (0..self.n_time_constants())
            .flat_map(|j| {
                self.gains
                    .memory
                    .iter()
                    .map(move |shares| inverse_softplus(shares[j]) as f32)
            })
            .collect();
        matrix(numbers, [self.n_time_constants(), self.n_taxels()], device)
    }
}

impl Network {
    /// A network that changes nothing yet.
    pub(crate) fn new(physics: &Physics, hidden: &[usize], seed_number: u64, device: &Device) -> Self {
        let n_taxels = physics.n_taxels();
        let mut layers = Vec::new();
        if physics.variant.has_perceptron() {
            let widths = [&[n_taxels], hidden, &[n_taxels]].concat();
            let mut random = seed::stream(seed_number, &format!("weights/{}", physics.variant));
            for (layer, pair) in widths.windows(2).enumerate() {
                let last = layer + 2 == widths.len();
                // Uniform within ±1/√width, as Linear does by itself, but from a stream of our own.
                let reach = if last && physics.variant != Variant::Paper {
                    0.0
                } else {
                    (pair[0] as f32).sqrt().recip()
                };
                let mut draw = |count: usize| {
                    (0..count)
                        .map(|_| reach * random.random_range(-1.0_f32..1.0))
                        .collect()
                };
                let weight = Param::from_tensor(matrix(draw(pair[0] * pair[1]), [pair[0], pair[1]], device));
                let bias = Some(Param::from_tensor(vector(draw(pair[1]), device)));
                layers.push(Linear { weight, bias });
            }
        }
        Self {
            gain_change: Param::from_tensor(Tensor::zeros([n_taxels], device)),
            memory_change: Param::from_tensor(Tensor::zeros([physics.n_time_constants(), n_taxels], device)),
            layers,
        }
    }

    /// Elastic readings of order one, `[n_rows, n_taxels]`, from [`Physics::inputs`]. What the perceptron
    /// sees may be noisier than what the physics sees.
    pub(crate) fn elastic(&self, physics: &Physics, inputs: Tensor<2>, seen: Tensor<2>) -> Tensor<2> {
        if physics.variant == Variant::Paper {
            return self.perceptron(seen);
        }
        let gains = physics.start_gains(&inputs.device()) * self.gain_change.val().exp();
        let physical = inputs * gains.unsqueeze_dim::<2>(0);
        if self.layers.is_empty() {
            return physical;
        }
        let size = (physical.clone().square().sum_dim(1) + ROUNDING).sqrt();
        physical + size * self.perceptron(seen).tanh() * physics.correction_limit
    }

    fn perceptron(&self, inputs: Tensor<2>) -> Tensor<2> {
        let mut rows = inputs;
        for (index, layer) in self.layers.iter().enumerate() {
            rows = layer.forward(rows);
            if index + 1 < self.layers.len() {
                rows = activation::gelu(rows);
            }
        }
        rows
    }

    /// Share of each overstress in the reading, not negative; `[n_time_constants, n_taxels]`.
    pub(crate) fn memory(&self, physics: &Physics) -> Tensor<2> {
        let change = self.memory_change.val();
        activation::softplus(physics.start_memory(&change.device()) + change, 1.0)
    }

    /// The gains as learned.
    pub(crate) fn gains(&self, physics: &Physics) -> Gains {
        let change = numbers(self.gain_change.val());
        let memory = if physics.n_time_constants() > 0 {
            numbers(self.memory(physics))
        } else {
            Vec::new()
        };
        let n_taxels = physics.n_taxels();
        Gains {
            gain: physics
                .gains
                .gain
                .iter()
                .zip(change)
                .map(|(gain, c)| gain * f64::from(c).exp())
                .collect(),
            memory: (0..n_taxels)
                .map(|k| {
                    memory
                        .iter()
                        .skip(k)
                        .step_by(n_taxels)
                        .map(|share| f64::from(*share))
                        .collect()
                })
                .collect(),
            time_constants_s: physics.gains.time_constants_s[..physics.n_time_constants()].to_vec(),
        }
    }

    /// The weights, by name.
    pub(crate) fn weights(&self) -> Weights {
        let mut weights = Weights::new();
        let mut put = |name: String, shape: Vec<usize>, data: Vec<f32>| weights.insert(name, (shape, data));
        put(
            "gain_change".into(),
            self.gain_change.val().dims().to_vec(),
            numbers(self.gain_change.val()),
        );
        put(
            "memory_change".into(),
            self.memory_change.val().dims().to_vec(),
            numbers(self.memory_change.val()),
        );
        for (index, layer) in self.layers.iter().enumerate() {
            put(
                format!("layer{index}.weight"),
                layer.weight.val().dims().to_vec(),
                numbers(layer.weight.val()),
            );
            if let Some(bias) = &layer.bias {
                put(
                    format!("layer{index}.bias"),
                    bias.val().dims().to_vec(),
                    numbers(bias.val()),
                );
            }
        }
        weights
    }

    /// A network with given weights; the error says which do not fit.
    pub(crate) fn with_weights(
        physics: &Physics,
        hidden: &[usize],
        weights: &Weights,
    ) -> Result<Self, String> {
        let device = device();
        let blank = Self::new(physics, hidden, 0, &device);
        let expected = blank.weights();
        for (name, (shape, _)) in &expected {
            match weights.get(name) {
                Some((found, data)) if found == shape && data.len() == shape.iter().product::<usize>() => {}
                Some((found, _)) => return Err(format!("`{name}` has shape {found:?}, expected {shape:?}")),
                None => return Err(format!("`{name}` is missing")),
            }
        }
        if let Some(name) = weights.keys().find(|name| !expected.contains_key(*name)) {
            return Err(format!("`{name}` is unknown"));
        }
        let first = |name: &str| Param::from_tensor(vector(weights[name].1.clone(), &device));
        let second = |name: &str| {
            let (shape, data) = &weights[name];
            Param::from_tensor(matrix(data.clone(), [shape[0], shape[1]], &device))
        };
        Ok(Self {
            gain_change: first("gain_change"),
            memory_change: second("memory_change"),
            layers: (0..blank.layers.len())
                .map(|index| Linear {
                    weight: second(&format!("layer{index}.weight")),
                    bias: Some(first(&format!("layer{index}.bias"))),
                })
                .collect(),
        })
    }
}

/// The processor, single-threaded, so that sums always run in the same order.
pub(crate) fn device() -> Device {
    Device::flex()
}

pub(crate) fn vector(data: Vec<f32>, device: &Device) -> Tensor<1> {
    let length = data.len();
    Tensor::from_data(TensorData::new(data, [length]), device)
}

pub(crate) fn matrix(data: Vec<f32>, shape: [usize; 2], device: &Device) -> Tensor<2> {
    Tensor::from_data(TensorData::new(data, shape), device)
}

/// The numbers of a tensor, row by row.
pub(crate) fn numbers<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().iter::<f32>().collect()
}
