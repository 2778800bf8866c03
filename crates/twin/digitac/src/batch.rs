//! Whole presses as tensors.

use burn::tensor::{Device, Tensor, TensorData};

use crate::memory::operator;
use crate::network::{Network, Physics, matrix};
use crate::{Features, PairedPress, seed};

/// Presses side by side, padded to the longest.
pub(crate) struct Batch {
    n_presses: usize,
    n_frames: usize,
    /// `[n_presses * n_frames, n_taxels]`
    inputs: Tensor<2>,
    /// Over the largest reading; `[n_presses * n_frames, n_taxels]`
    targets: Tensor<2>,
    /// One where a reading counts; `[n_presses * n_frames, n_taxels]`
    mask: Tensor<2>,
    n_counted: f64,
    /// From elastic readings to overstresses; `[n_presses, n_time_constants * n_frames, n_frames]`, if the
    /// variant remembers.
    overstress: Option<Tensor<3>>,
}

impl Batch {
    /// Gathers presses, of which only every so many frames are used if they are longer than `max_frames`.
    pub(crate) fn new(
        physics: &Physics,
        presses: &[&PairedPress],
        max_frames: usize,
        device: &Device,
    ) -> Self {
        let thinned: Vec<PairedPress> = presses.iter().map(|press| thin(press, max_frames)).collect();
        let n_frames = thinned
            .iter()
            .map(|press| press.features.n_frames())
            .max()
            .unwrap_or(0);
        let n_taxels = physics.n_taxels();
        let n_rows = thinned.len() * n_frames;
        let (mut inputs, mut targets, mut mask) = (
            vec![0.0; n_rows * n_taxels],
            vec![0.0; n_rows * n_taxels],
            vec![0.0; n_rows * n_taxels],
        );
        for (index, press) in thinned.iter().enumerate() {
            let start = index * n_frames * n_taxels;
            let own = physics.inputs(&press.features);
            inputs[start..start + own.len()].copy_from_slice(&own);
            let readings = press
                .readings_kpa
                .iter()
                .flatten()
                .zip(press.valid.iter().flatten());
            for (at, (reading, valid)) in readings.enumerate().filter(|(_, (_, valid))| **valid) {
                targets[start + at] = (reading / physics.normalization.reading_kpa) as f32;
                mask[start + at] = f32::from(u8::from(*valid));
            }
        }
        let n_counted = mask.iter().filter(|m| **m > 0.0).count().max(1) as f64;
        let remembers = physics.n_time_constants() > 0 && n_frames > 1;
        Self {
            n_presses: thinned.len(),
            n_frames,
            inputs: matrix(inputs, [n_rows, n_taxels], device),
            targets: matrix(targets, [n_rows, n_taxels], device),
            mask: matrix(mask, [n_rows, n_taxels], device),
            n_counted,
            overstress: remembers.then(|| operators(physics, &thinned, n_frames, device)),
        }
    }

    /// Mean absolute deviation over the largest reading. `noise` is the deviation of noise on what the
    /// perceptron sees, with its stream.
    pub(crate) fn loss(
        &self,
        network: &Network,
        physics: &Physics,
        noise: Option<(f64, &mut twintac_random::RandomStream)>,
    ) -> Tensor<1> {
        let seen = match noise {
            Some((deviation, random)) if physics.variant.has_perceptron() && deviation > 0.0 => {
                let shape = self.inputs.dims();
                let noise = (0..shape[0] * shape[1])
                    .map(|_| (deviation * seed::normal(random)) as f32)
                    .collect();
                self.inputs.clone() + matrix(noise, shape, &self.inputs.device())
            }
            _ => self.inputs.clone(),
        };
        let elastic = network.elastic(physics, self.inputs.clone(), seen);
        let readings = self.remember(network, physics, elastic);
        ((readings - self.targets.clone()).abs() * self.mask.clone()).sum() / self.n_counted
    }

    pub(crate) fn n_counted(&self) -> f64 {
        self.n_counted
    }

    fn remember(&self, network: &Network, physics: &Physics, elastic: Tensor<2>) -> Tensor<2> {
        let Some(overstress) = &self.overstress else {
            return elastic;
        };
        let (n_taxels, n_constants) = (physics.n_taxels(), physics.n_time_constants());
        let by_press: Tensor<3> = elastic.clone().reshape([self.n_presses, self.n_frames, n_taxels]);
        let q: Tensor<4> = overstress.clone().matmul(by_press).reshape([
            self.n_presses,
            n_constants,
            self.n_frames,
            n_taxels,
        ]);
        let shares: Tensor<4> = network.memory(physics).reshape([1, n_constants, 1, n_taxels]);
        let remembered: Tensor<2> = (q * shares)
            .sum_dim(1)
            .reshape([self.n_presses * self.n_frames, n_taxels]);
        elastic + remembered
    }
}

fn operators(physics: &Physics, presses: &[PairedPress], n_frames: usize, device: &Device) -> Tensor<3> {
    let constants = &physics.gains.time_constants_s;
    let mut numbers = vec![0.0_f32; presses.len() * constants.len() * n_frames * n_frames];
    let mut blocks = numbers.chunks_mut(n_frames * n_frames);
    for press in presses {
        let own_frames = press.features.n_frames();
        for constant_s in constants {
            let own = operator(&press.features.time_s, *constant_s);
            if let Some(block) = blocks.next() {
                for (row, own) in block.chunks_mut(n_frames).zip(own.chunks(own_frames)) {
                    row.iter_mut().zip(own).for_each(|(to, from)| *to = *from as f32);
                }
            }
        }
    }
    let shape = [presses.len(), constants.len() * n_frames, n_frames];
    Tensor::from_data(TensorData::new(numbers, shape), device)
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
    };
    let (readings_kpa, valid) = (every(&press.readings_kpa, stride), every(&press.valid, stride));
    PairedPress {
        features,
        readings_kpa,
        valid,
        ..press.clone()
    }
}
