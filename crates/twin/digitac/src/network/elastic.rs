//! Elastic readings, and their gradient with respect to the parameters.

use super::perceptron::{self, PerceptronPass};
use twintac_learn::Matrix;

use super::{Parameters, Physics, Variant};

/// Added to the sum of squares of a frame's readings, in units of the largest reading, so that the
/// slope of its square root stays finite.
const ROUNDING: f32 = 1e-8;

/// Elastic readings, and the values that their gradient needs.
pub(crate) struct Pass {
    /// Elastic readings of order one; `[n_rows][n_taxels]`.
    pub(crate) readings: Matrix,
    perceptron: Option<PerceptronPass>,
    correction: Option<Correction>,
}

/// A correction that is limited to a fraction of the size of a row's physical readings.
struct Correction {
    /// The readings without correction; `[n_rows][n_taxels]`.
    physical: Matrix,
    /// Rounded sum of their squares; `[n_rows]`.
    squares: Vec<f32>,
    /// Correction over its limit, between -1 and 1; `[n_rows][n_taxels]`.
    shares: Matrix,
}

/// Memory for elastic readings of some rows, so that computing readings allocates none.
#[derive(Clone, Debug)]
pub(crate) struct ElasticRows {
    /// Inputs of order one; `[n_rows][n_taxels]`.
    inputs: Matrix,
    /// Readings of order one; `[n_rows][n_taxels]`.
    readings: Matrix,
    /// Outputs of each layer; `[n_layers]`.
    layers: Vec<Matrix>,
}

impl ElasticRows {
    /// Memory for this many rows.
    pub(crate) fn new(parameters: &Parameters, n_rows: usize) -> Self {
        let n_taxels = parameters.gain_change.len();
        let layers = parameters.layers.iter();
        Self {
            inputs: Matrix::zeros(n_rows, n_taxels),
            readings: Matrix::zeros(n_rows, n_taxels),
            layers: layers
                .map(|layer| Matrix::zeros(n_rows, layer.bias.len()))
                .collect(),
        }
    }

    /// Elastic readings of order one from the variant's inputs, with the gains of
    /// [`Parameters::elastic_gains`]. Each row has the same bits as from [`Parameters::elastic`].
    /// `seen` has at most the allocated number of rows; `[n_rows * n_taxels]`.
    pub(crate) fn read(
        &mut self,
        parameters: &Parameters,
        physics: &Physics,
        gains: &[f32],
        seen: &[f64],
    ) -> &[f32] {
        let n_taxels = self.inputs.n_columns.max(1);
        self.inputs.values.resize(seen.len(), 0.0);
        for (row, seen) in self.inputs.rows_mut().zip(seen.chunks_exact(n_taxels)) {
            physics.scale(seen, row);
        }
        if physics.variant == Variant::Paper {
            return &perceptron::outputs(&parameters.layers, &self.inputs, &mut self.layers).values;
        }
        self.readings.values.clear();
        self.readings.values.extend_from_slice(&self.inputs.values);
        multiply(&mut self.readings, gains);
        if !parameters.layers.is_empty() {
            let limit = physics.correction_limit as f32;
            let shares = perceptron::outputs(&parameters.layers, &self.inputs, &mut self.layers);
            shares.values.iter_mut().for_each(|value| *value = value.tanh());
            for (row, shares) in self.readings.rows_mut().zip(shares.rows()) {
                let square = square(row);
                correct(row, square, shares, limit);
            }
        }
        &self.readings.values
    }
}

/// Multiplies each column by its gain.
fn multiply(rows: &mut Matrix, gains: &[f32]) {
    for row in rows.rows_mut() {
        row.iter_mut().zip(gains).for_each(|(value, gain)| *value *= gain);
    }
}

/// Rounded sum of the squares of a row's physical readings.
fn square(physical: &[f32]) -> f32 {
    physical.iter().map(|p| p * p).sum::<f32>() + ROUNDING
}

/// Adds the corrections to the physical readings of a row.
fn correct(readings: &mut [f32], square: f32, shares: &[f32], limit: f32) {
    for (reading, share) in readings.iter_mut().zip(shares) {
        *reading += square.sqrt() * share * limit;
    }
}

impl Parameters {
    /// Ratio of readings of order one to inputs of order one; `[n_taxels]`.
    pub(crate) fn elastic_gains(&self, physics: &Physics) -> Vec<f32> {
        let changed = physics.start_gains().into_iter().zip(&self.gain_change);
        changed.map(|(start, change)| start * change.exp()).collect()
    }

    /// Elastic readings of order one from [`Physics::inputs`]. `seen` are the inputs of the
    /// perceptron, which may have noise.
    pub(crate) fn elastic(&self, physics: &Physics, inputs: &Matrix, seen: &Matrix) -> Pass {
        if physics.variant == Variant::Paper {
            let (readings, pass) = perceptron::forward(&self.layers, seen);
            return Pass {
                readings,
                perceptron: Some(pass),
                correction: None,
            };
        }
        let mut physical = inputs.clone();
        multiply(&mut physical, &self.elastic_gains(physics));
        if self.layers.is_empty() {
            return Pass {
                readings: physical,
                perceptron: None,
                correction: None,
            };
        }
        let squares: Vec<f32> = physical.rows().map(square).collect();
        let (mut shares, pass) = perceptron::forward(&self.layers, seen);
        shares.values.iter_mut().for_each(|value| *value = value.tanh());
        let limit = physics.correction_limit as f32;
        let mut readings = physical.clone();
        for ((row, shares), square) in readings.rows_mut().zip(shares.rows()).zip(&squares) {
            correct(row, *square, shares, limit);
        }
        Pass {
            readings,
            perceptron: Some(pass),
            correction: Some(Correction {
                physical,
                squares,
                shares,
            }),
        }
    }

    /// Gradient with respect to all parameters except the memory's, from the gradient with respect
    /// to the elastic readings.
    pub(crate) fn elastic_gradient(
        &self,
        physics: &Physics,
        inputs: &Matrix,
        pass: &Pass,
        of_readings: Matrix,
    ) -> Self {
        let mut gradient = self.zeros_like();
        let of_physical = match (&pass.perceptron, &pass.correction) {
            (None, _) => of_readings,
            (Some(perceptron), None) => {
                gradient.layers = perceptron::gradient(&self.layers, perceptron, of_readings);
                return gradient;
            }
            (Some(perceptron), Some(correction)) => {
                let limit = physics.correction_limit as f32;
                let (of_physical, of_outputs) = correction.gradient(limit, &of_readings);
                gradient.layers = perceptron::gradient(&self.layers, perceptron, of_outputs);
                of_physical
            }
        };
        let mut of_gains = vec![0.0; physics.n_taxels()];
        for (row, inputs) in of_physical.rows().zip(inputs.rows()) {
            for ((sum, slope), input) in of_gains.iter_mut().zip(row).zip(inputs) {
                *sum += slope * input;
            }
        }
        let starts = physics.start_gains();
        for (((to, of_gain), start), change) in gradient
            .gain_change
            .iter_mut()
            .zip(of_gains)
            .zip(starts)
            .zip(&self.gain_change)
        {
            *to = of_gain * start * change.exp();
        }
        gradient
    }
}

impl Correction {
    /// Gradients with respect to the physical readings and to the perceptron's outputs.
    fn gradient(&self, limit: f32, of_readings: &Matrix) -> (Matrix, Matrix) {
        let (mut of_physical, mut of_outputs) = (of_readings.clone(), of_readings.clone());
        let rows = of_physical.rows_mut().zip(of_outputs.rows_mut());
        let own = self.physical.rows().zip(self.shares.rows()).zip(&self.squares);
        for ((of_physical, of_outputs), ((physical, shares), square)) in rows.zip(own) {
            let size = square.sqrt();
            of_outputs.iter_mut().for_each(|slope| *slope *= limit);
            let of_size: f32 = of_outputs
                .iter()
                .zip(shares)
                .map(|(slope, share)| slope * share)
                .sum();
            let of_square = of_size * (square.powf(-0.5) / 2.0);
            for (slope, p) in of_physical.iter_mut().zip(physical) {
                let by_square = of_square * p;
                *slope = by_square + (by_square + *slope);
            }
            for (slope, share) in of_outputs.iter_mut().zip(shares) {
                *slope = *slope * size * (1.0 - share * share);
            }
        }
        (of_physical, of_outputs)
    }
}
