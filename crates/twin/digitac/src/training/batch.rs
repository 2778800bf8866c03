//! Whole presses as matrices, the loss of a network on them, and its gradient.

use rand::seq::SliceRandom;
use twintac_random::RandomStream;

use crate::features::{overstress_matrix, port_reading, port_slopes};
use crate::network::{Parameters, Pass, Physics};
use crate::{Features, PairedPress, Variant, seed};
use twintac_learn::Matrix;

/// Presses side by side, padded to the longest.
pub(crate) struct Batch {
    n_frames: usize,
    /// Inputs of order one; `[n_presses * n_frames][n_taxels]`.
    inputs: Matrix,
    /// Readings over the largest reading; `[n_presses * n_frames][n_taxels]`.
    targets: Vec<f32>,
    /// 1 where a reading counts, else 0; `[n_presses * n_frames][n_taxels]`.
    mask: Vec<f32>,
    n_counted: f64,
    /// Relative growth of the elastic readings; `[n_taxels]`, empty for the paper's variant.
    stiffening: Vec<f64>,
    /// Matrices from the elastic readings of each press to its overstresses, `[n_time_constants *
    /// n_frames][n_frames]`; empty if the variant has no relaxation.
    operators: Vec<Matrix>,
}

/// Standard deviation of the noise on the perceptron's inputs, with its random stream.
pub(crate) type Noise<'a> = (f64, &'a mut RandomStream);

/// Values of the loss's computation that its gradient needs.
struct Forward {
    pass: Pass,
    /// Readings minus targets.
    deviations: Vec<f32>,
    /// Overstresses of each press, `[n_time_constants * n_frames][n_taxels]`.
    overstresses: Vec<Matrix>,
    /// Share of each overstress in the reading; `[n_time_constants][n_taxels]`.
    shares: Vec<f32>,
}

impl Batch {
    /// Collects presses. Of presses that are longer than `max_frames`, frames are used at equal
    /// intervals.
    pub(crate) fn new(physics: &Physics, presses: &[&PairedPress], max_frames: usize) -> Self {
        let thinned: Vec<PairedPress> = presses.iter().map(|press| thin(press, max_frames)).collect();
        let n_frames = thinned
            .iter()
            .map(|press| press.features.n_frames())
            .max()
            .unwrap_or(0);
        let n_taxels = physics.n_taxels();
        let n_rows = thinned.len() * n_frames;
        let mut inputs = Matrix::zeros(n_rows, n_taxels);
        let (mut targets, mut mask) = (vec![0.0; n_rows * n_taxels], vec![0.0; n_rows * n_taxels]);
        for (index, press) in thinned.iter().enumerate() {
            let start = index * n_frames * n_taxels;
            let own = physics.inputs(&press.features).values;
            inputs.values[start..start + own.len()].copy_from_slice(&own);
            let readings = press
                .readings_kpa
                .iter()
                .flatten()
                .zip(press.valid.iter().flatten());
            for (at, (reading, _)) in readings.enumerate().filter(|(_, (_, valid))| **valid) {
                targets[start + at] = (reading / physics.normalization.reading_kpa) as f32;
                mask[start + at] = 1.0;
            }
        }
        let n_counted = mask.iter().filter(|m| **m > 0.0).count().max(1) as f64;
        let remembers = physics.n_time_constants() > 0 && n_frames > 1;
        let operator =
            |press: &PairedPress| operator(&press.features.time_s, &physics.gains.time_constants_s, n_frames);
        Self {
            n_frames,
            inputs,
            targets,
            mask,
            n_counted,
            stiffening: if physics.variant == Variant::Paper {
                vec![0.0; n_taxels]
            } else {
                physics.stiffening()
            },
            operators: if remembers {
                thinned.iter().map(operator).collect()
            } else {
                Vec::new()
            },
        }
    }

    /// Number of readings that count.
    pub(crate) fn n_counted(&self) -> f64 {
        self.n_counted
    }

    /// Mean absolute deviation over the largest reading.
    pub(crate) fn loss(&self, parameters: &Parameters, physics: &Physics) -> f32 {
        self.mean_deviation(&self.forward(parameters, physics, &self.inputs))
    }

    /// The loss, with noise on the perceptron's inputs, and its gradient.
    pub(crate) fn loss_and_gradient(
        &self,
        parameters: &Parameters,
        physics: &Physics,
        (deviation, random): Noise<'_>,
    ) -> (f32, Parameters) {
        let mut seen = self.inputs.clone();
        if physics.variant.has_perceptron() && deviation > 0.0 {
            for value in &mut seen.values {
                *value += (deviation * seed::normal(random)) as f32;
            }
        }
        let forward = self.forward(parameters, physics, &seen);
        let loss = self.mean_deviation(&forward);
        (loss, self.gradient(parameters, physics, &forward))
    }

    fn forward(&self, parameters: &Parameters, physics: &Physics, seen: &Matrix) -> Forward {
        let pass = parameters.elastic(physics, &self.inputs, seen);
        let elastic = pass.readings.values.iter().zip(self.stiffening.iter().cycle());
        let relaxed: Vec<f32> = elastic
            .map(|(e, s)| port_reading(*s, f64::from(*e)) as f32)
            .collect();
        let mut readings = relaxed.clone();
        let n_taxels = physics.n_taxels();
        let n_values = self.n_frames * n_taxels;
        let shares = parameters.memory(physics);
        let mut overstresses = Vec::with_capacity(self.operators.len());
        for (index, operator) in self.operators.iter().enumerate() {
            let press = index * n_values..(index + 1) * n_values;
            let elastic = Matrix {
                values: relaxed[press.clone()].to_vec(),
                n_columns: n_taxels,
            };
            let overstress = operator.times(&elastic);
            let mut remembered = vec![0.0; n_values];
            let by_constant = overstress.values.chunks_exact(n_values);
            for (overstress, shares) in by_constant.zip(shares.chunks_exact(n_taxels)) {
                let values = overstress.iter().zip(shares.iter().cycle());
                for (sum, (value, share)) in remembered.iter_mut().zip(values) {
                    *sum += value * share;
                }
            }
            for (reading, remembered) in readings[press].iter_mut().zip(remembered) {
                *reading += remembered;
            }
            overstresses.push(overstress);
        }
        let deviations = readings.iter().zip(&self.targets).map(|(r, target)| r - target);
        Forward {
            deviations: deviations.collect(),
            pass,
            overstresses,
            shares,
        }
    }

    fn mean_deviation(&self, forward: &Forward) -> f32 {
        let counted = forward.deviations.iter().zip(&self.mask);
        counted.map(|(deviation, m)| deviation.abs() * m).sum::<f32>() / self.n_counted as f32
    }

    fn gradient(&self, parameters: &Parameters, physics: &Physics, forward: &Forward) -> Parameters {
        let n_taxels = physics.n_taxels();
        let n_values = self.n_frames * n_taxels;
        let weight = 1.0 / self.n_counted as f32;
        let counted = forward.deviations.iter().zip(&self.mask);
        let of_readings = Matrix {
            values: counted
                .map(|(deviation, m)| weight * m * sign(*deviation))
                .collect(),
            n_columns: n_taxels,
        };
        let mut of_elastic = of_readings.clone();
        // Sums over the presses first, then over the frames.
        let mut of_shares = vec![0.0; forward.shares.len() * self.n_frames];
        for (index, (operator, overstress)) in self.operators.iter().zip(&forward.overstresses).enumerate() {
            let press = index * n_values..(index + 1) * n_values;
            let of_readings = &of_readings.values[press.clone()];
            let mut of_overstress = Matrix::zeros(overstress.n_rows(), n_taxels);
            let by_constant = of_overstress.values.chunks_exact_mut(n_values);
            for (of_overstress, shares) in by_constant.zip(forward.shares.chunks_exact(n_taxels)) {
                let slopes = of_readings.iter().zip(shares.iter().cycle());
                for (to, (slope, share)) in of_overstress.iter_mut().zip(slopes) {
                    *to = slope * share;
                }
            }
            let values = of_shares.iter_mut().zip(&overstress.values);
            for ((sum, value), slope) in values.zip(of_readings.iter().cycle()) {
                *sum += slope * value;
            }
            let through = operator.transposed_times(&of_overstress);
            for (to, through) in of_elastic.values[press].iter_mut().zip(&through.values) {
                *to += through;
            }
        }
        let elastic = forward
            .pass
            .readings
            .values
            .iter()
            .zip(self.stiffening.iter().cycle());
        for (slope, (e, s)) in of_elastic.values.iter_mut().zip(elastic) {
            *slope *= port_slopes(*s, f64::from(*e))[0] as f32;
        }
        let mut gradient = parameters.elastic_gradient(physics, &self.inputs, &forward.pass, of_elastic);
        if !self.operators.is_empty() {
            let of_memory: Vec<f32> = of_shares
                .chunks_exact(n_values)
                .flat_map(|values| {
                    let by_frame = Matrix {
                        values: values.to_vec(),
                        n_columns: n_taxels,
                    };
                    by_frame.column_sums()
                })
                .collect();
            gradient.memory_change = parameters.memory_gradient(physics, &of_memory);
        }
        gradient
    }
}

/// The derivative of an absolute value; 0 at 0.
fn sign(value: f32) -> f32 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

/// Matrix from the elastic readings of a press with at most `n_frames` frames to its overstresses,
/// padded with zeros.
fn operator(time_s: &[f64], time_constants_s: &[f64], n_frames: usize) -> Matrix {
    let mut operator = Matrix::zeros(time_constants_s.len() * n_frames, n_frames);
    let blocks = operator.values.chunks_exact_mut(n_frames * n_frames);
    for (block, constant_s) in blocks.zip(time_constants_s) {
        let own = overstress_matrix(time_s, *constant_s);
        for (row, own) in block
            .chunks_exact_mut(n_frames)
            .zip(own.chunks_exact(time_s.len()))
        {
            row.iter_mut().zip(own).for_each(|(to, from)| *to = *from as f32);
        }
    }
    operator
}

/// A press with at most `max_frames` frames.
pub(crate) fn thin(press: &PairedPress, max_frames: usize) -> PairedPress {
    fn every<T: Clone>(values: &[T], stride: usize) -> Vec<T> {
        values.iter().step_by(stride).cloned().collect()
    }
    let stride = press.features.n_frames().div_ceil(max_frames).max(1);
    let f = &press.features;
    let features = Features {
        time_s: every(&f.time_s, stride),
        depth_mm: every(&f.depth_mm, stride),
        force_n: every(&f.force_n, stride),
        pressure_kpa: every(&f.pressure_kpa, stride),
        stress_kpa_per_mm: every(&f.stress_kpa_per_mm, stride),
        simulated: every(&f.simulated, stride),
        since_previous_s: None,
        zero_frames: 0..0,
    };
    let (readings_kpa, valid) = (every(&press.readings_kpa, stride), every(&press.valid, stride));
    PairedPress {
        features,
        readings_kpa,
        valid,
        ..press.clone()
    }
}

/// Divides indices into shuffled batches of about equal size.
pub(crate) fn batches(indices: &[usize], size: usize, seed_number: u64) -> Vec<Vec<usize>> {
    let mut shuffled = indices.to_vec();
    shuffled.shuffle(&mut seed::stream(seed_number, "batches"));
    let count = shuffled.len().div_ceil(size.max(1)).max(1);
    let size = shuffled.len().div_ceil(count).max(1);
    shuffled.chunks(size).map(<[usize]>::to_vec).collect()
}

#[cfg(test)]
mod tests {
    use rand::Rng;

    use super::*;
    use crate::features::Gains;
    use crate::network::Normalization;
    use crate::synthetic::by_hand;

    fn physics(variant: Variant) -> Physics {
        Physics {
            variant,
            gains: Gains {
                gain: vec![0.8, 1.3],
                stiffening_per_kpa: vec![0.3, -0.2],
                memory: vec![vec![0.2, 0.1], vec![0.3, 0.05]],
                time_constants_s: vec![0.25, 4.0],
            },
            normalization: Normalization {
                reading_kpa: 2.0,
                pressure_rms_kpa: vec![1.5, 2.5],
                stress_mean_kpa_per_mm: vec![0.3, 0.4],
                stress_deviation_kpa_per_mm: vec![0.9, 1.1],
            },
            correction_limit: 0.3,
        }
    }

    /// A press of `n_frames` with varying features, two taxels. Its readings are far from any
    /// prediction, on both sides, because the loss has a corner where they are equal.
    fn press(n_frames: usize, phase: f64) -> PairedPress {
        let wave = |i: usize, shift: f64| 1.0 + (0.7 * i as f64 + phase + shift).sin();
        let frames: Vec<_> = (0..n_frames)
            .map(|i| (1.0, if i % 2 == 0 { [10.0, -10.0] } else { [-10.0, 10.0] }))
            .collect();
        let mut press = by_hand("press", "file", [0.0, 0.0], &frames);
        let rows = |shift: f64| (0..n_frames).map(move |i| vec![wave(i, shift), wave(i, 2.0 * shift)]);
        press.features.pressure_kpa = rows(0.6).collect();
        press.features.stress_kpa_per_mm = rows(1.1).collect();
        press
    }

    #[test]
    fn gradients_are_quotients_of_differences() {
        let step = 1e-2_f32;
        let mut random = seed::stream(5, "test");
        for variant in Variant::ALL {
            let physics = physics(variant);
            let (long, short) = (press(9, 0.0), press(6, 1.0));
            let batch = Batch::new(&physics, &[&long, &short], 128);
            let mut parameters = Parameters::new(&physics, &[5, 4], 3);
            for value in parameters.arrays_mut().flatten() {
                *value += random.random_range(-0.4..0.4);
            }
            let (_, gradient) = batch.loss_and_gradient(&parameters, &physics, (0.0, &mut random));
            for (index, slopes) in gradient.arrays().enumerate() {
                let direction: Vec<f32> = slopes.iter().map(|_| random.random_range(-1.0..1.0)).collect();
                let moved = |by: f32| {
                    let mut moved = parameters.clone();
                    let array = moved.arrays_mut().nth(index).unwrap();
                    array.iter_mut().zip(&direction).for_each(|(p, d)| *p += by * d);
                    f64::from(batch.loss(&moved, &physics))
                };
                let quotient = (moved(step) - moved(-step)) / f64::from(2.0 * step);
                let slope: f64 = slopes.iter().zip(&direction).map(|(s, d)| f64::from(s * d)).sum();
                assert!(
                    (slope - quotient).abs() < 2e-4 + 0.01 * quotient.abs(),
                    "{variant}, array {index}: {slope}, quotient {quotient}"
                );
            }
        }
    }

    #[test]
    fn batches_hold_every_index_once() {
        let batches = batches(&(10..45).collect::<Vec<_>>(), 8, 3);
        assert!(
            batches.iter().all(|batch| (5..=8).contains(&batch.len())),
            "{batches:?}"
        );
        let mut all = batches.concat();
        all.sort_unstable();
        assert_eq!(all, (10..45).collect::<Vec<_>>());
    }
}
