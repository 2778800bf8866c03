//! The optimizer AdamW (Loshchilov and Hutter, arXiv 1711.05101).

/// Decay rate β₁ of the running mean of the gradients.
const BETA_1: f32 = 0.9;

/// Decay rate β₂ of the running mean of their squares.
const BETA_2: f32 = 0.999;

/// Keeps steps finite where gradients are close to zero.
const EPSILON: f32 = 1e-5;

/// Settings that stay the same in all steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdamWSettings {
    /// Weight decay: each step multiplies the parameters by 1 minus this times the learning rate.
    pub weight_decay: f32,
    /// Largest Euclidean norm of the gradient, over all arrays together: a longer gradient is
    /// scaled down to it.
    pub gradient_norm: f32,
}

/// The optimizer with its state.
pub struct AdamW {
    settings: AdamWSettings,
    n_steps: i32,
    /// For each array, running means of the gradients and of their squares.
    moments: Vec<[Vec<f32>; 2]>,
}

impl AdamW {
    /// An optimizer of these arrays, before its first step.
    pub fn new<'a>(arrays: impl Iterator<Item = &'a Vec<f32>>, settings: AdamWSettings) -> Self {
        let moments = |array: &Vec<f32>| [(); 2].map(|()| vec![0.0; array.len()]);
        Self {
            settings,
            n_steps: 0,
            moments: arrays.map(moments).collect(),
        }
    }

    /// Does one step: `arrays` are the parameters, and `gradient` has the same arrays in the same
    /// order.
    pub fn step<'a>(
        &mut self,
        learning_rate: f64,
        arrays: impl Iterator<Item = &'a mut Vec<f32>>,
        gradient: impl Iterator<Item = &'a Vec<f32>> + Clone,
    ) {
        self.n_steps += 1;
        let kept = (1.0 - learning_rate * f64::from(self.settings.weight_decay)) as f32;
        let [unbiased_1, unbiased_2] = [BETA_1, BETA_2].map(|beta| 1.0 - beta.powi(self.n_steps));
        let scale = clip(gradient.clone(), self.settings.gradient_norm);
        for ((array, gradient), [means, squares]) in arrays.zip(gradient).zip(&mut self.moments) {
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

/// The factor (at most 1) that scales a gradient down to the norm `largest_norm`.
fn clip<'a>(gradient: impl Iterator<Item = &'a Vec<f32>>, largest_norm: f32) -> f32 {
    let square: f32 = gradient.flatten().map(|slope| slope * slope).sum();
    (1.0 / (square.sqrt() + f32::MIN_POSITIVE) * largest_norm).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETTINGS: AdamWSettings = AdamWSettings {
        weight_decay: 0.0,
        gradient_norm: 1.0,
    };

    #[test]
    fn the_first_step_is_as_long_as_the_learning_rate() {
        let mut arrays = [vec![1.0_f32, -2.0]];
        let mut optimizer = AdamW::new(arrays.iter(), SETTINGS);
        optimizer.step(0.1, arrays.iter_mut(), [vec![0.5, -0.5]].iter());
        assert!((arrays[0][0] - 0.9).abs() < 1e-4 && (arrays[0][1] + 1.9).abs() < 1e-4);
    }

    #[test]
    fn a_bowl_is_descended_to_its_bottom() {
        let mut arrays = [vec![3.0_f32], vec![-4.0_f32, 0.5]];
        let mut optimizer = AdamW::new(arrays.iter(), SETTINGS);
        for step in 0..2000 {
            let gradient = arrays
                .clone()
                .map(|array| array.iter().map(|x| 2.0 * (x - 1.0)).collect());
            optimizer.step(
                0.02 / (1.0 + 0.01 * f64::from(step)),
                arrays.iter_mut(),
                gradient.iter(),
            );
        }
        assert!(
            arrays.iter().flatten().all(|x| (x - 1.0).abs() < 1e-2),
            "{arrays:?}"
        );
    }

    #[test]
    fn gradients_are_clipped_together() {
        let gradient = [vec![3.0], vec![0.0, 4.0]];
        assert!((clip(gradient.iter(), 1.0) - 0.2).abs() < 1e-6);
        assert_eq!(clip(gradient.iter(), 10.0), 1.0);
    }
}
