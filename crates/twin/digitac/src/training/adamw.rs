//! The optimizer AdamW (Loshchilov and Hutter, arXiv 1711.05101), with gradients clipped array by array.

use crate::network::Parameters;

/// Decay rate β₁ of the running mean of the gradients.
const BETA_1: f32 = 0.9;

/// Decay rate β₂ of the running mean of their squares.
const BETA_2: f32 = 0.999;

/// Keeps steps finite where gradients vanish.
const EPSILON: f32 = 1e-5;

/// The optimizer with its state.
pub(crate) struct AdamW {
    weight_decay: f32,
    largest_norm: f32,
    n_steps: i32,
    /// Means of the gradients and of their squares, of each array.
    moments: Vec<[Vec<f32>; 2]>,
}

impl AdamW {
    /// An optimizer that has not moved yet. No array's gradient counts as longer than `largest_norm`.
    pub(crate) fn new(parameters: &Parameters, weight_decay: f32, largest_norm: f32) -> Self {
        let moments = |array: &Vec<f32>| [(); 2].map(|()| vec![0.0; array.len()]);
        Self {
            weight_decay,
            largest_norm,
            n_steps: 0,
            moments: parameters.arrays().map(moments).collect(),
        }
    }

    /// Moves the parameters against the gradient.
    pub(crate) fn step(&mut self, learning_rate: f64, parameters: &mut Parameters, gradient: &Parameters) {
        self.n_steps += 1;
        let kept = (1.0 - learning_rate * f64::from(self.weight_decay)) as f32;
        let [unbiased_1, unbiased_2] = [BETA_1, BETA_2].map(|beta| 1.0 - beta.powi(self.n_steps));
        let arrays = parameters.arrays_mut().zip(gradient.arrays());
        for ((array, gradient), [means, squares]) in arrays.zip(&mut self.moments) {
            let scale = clip(gradient, self.largest_norm);
            for (((parameter, slope), mean), square) in array.iter_mut().zip(gradient).zip(means).zip(squares)
            {
                let slope = slope * scale;
                *mean = *mean * BETA_1 + slope * (1.0 - BETA_1);
                *square = *square * BETA_2 + slope * slope * (1.0 - BETA_2);
                let step = (*mean / unbiased_1) / ((*square / unbiased_2).sqrt() + EPSILON);
                *parameter = *parameter * kept - step * learning_rate as f32;
            }
        }
    }
}

/// The factor that makes a gradient no longer than `largest_norm`.
fn clip(gradient: &[f32], largest_norm: f32) -> f32 {
    let norm = gradient.iter().map(|slope| slope * slope).sum::<f32>().sqrt();
    (1.0 / (norm + f32::MIN_POSITIVE) * largest_norm).min(1.0)
}
