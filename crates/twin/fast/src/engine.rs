//! The networks as they are evaluated: only what touches is multiplied.

use glam::DVec2;
use pulp::{Arch, Simd, WithSimd};
use twintac_learn::Linear;

use crate::FastGel;
use crate::contact::N_CHANNELS;
use crate::layout::Layout;
use crate::network::{LocalNetwork, Turn, silu};
use crate::networks::{PRESSURE_KPA, WRENCH};

/// Units that are summed up side by side; layers are filled up with zeros to whole numbers of the second.
const LANES: [usize; 2] = [64, 32];

/// A network most of whose points have nothing near them.
#[derive(Clone, Debug)]
struct Sparse {
    /// From the channels of a point to its features.
    point: Linear,
    /// Features of a point near which nothing is, which are taken off.
    nothing: Vec<f32>,
    /// What the layer after the points adds for each unit of a feature. `[n_rows][n_hidden]`
    rows: Vec<f32>,
    /// Its outputs, rounded up to whole lanes.
    n_hidden: usize,
    /// The layers after that.
    rest: Vec<Dense>,
}

/// A layer, filled up.
#[derive(Clone, Debug)]
struct Dense {
    /// `[n_inputs][n_outputs]`
    weights: Vec<f32>,
    /// `[n_outputs]`
    bias: Vec<f32>,
    n_inputs: usize,
}

/// One output of a sparse network: which of its rows the inputs have, and what does not change.
#[derive(Clone, Debug)]
struct Port {
    /// The first row of each point of the grid; [`NOWHERE`] if it is out of reach.
    rows: Vec<u32>,
    /// `[n_hidden]`
    bias: Vec<f32>,
}

const NOWHERE: u32 = u32::MAX;

/// The networks of a fast gel, laid out for speed.
#[derive(Clone, Debug)]
pub(crate) struct Engine {
    pressure: Sparse,
    ports: Vec<Port>,
    wrench: Sparse,
    anywhere: Port,
    n_points: usize,
}

/// What an evaluation writes to.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    /// The numbers of points that something is near.
    near: Vec<u32>,
    /// The features of these points, one after the other.
    features: Vec<f32>,
    /// Rows and what they are multiplied by.
    terms: Vec<(u32, f32)>,
    hidden: [Vec<f32>; 2],
}

impl Sparse {
    fn of(network: &LocalNetwork) -> Self {
        let first = &network.rest.layers[0];
        let n_hidden = first.bias.len().next_multiple_of(LANES[1]);
        let mut rows = Vec::with_capacity(first.weight.n_rows() * n_hidden);
        for row in first.weight.rows() {
            rows.extend(padded(row, n_hidden));
        }
        Self {
            point: network.point.clone(),
            nothing: network.nothing(),
            rows,
            n_hidden,
            rest: network.rest.layers[1..].iter().map(Dense::of).collect(),
        }
    }
}

impl Dense {
    fn of(layer: &Linear) -> Self {
        let n_outputs = layer.bias.len().next_multiple_of(LANES[1]);
        let rows = layer.weight.rows();
        Self {
            weights: rows.flat_map(|row| padded(row, n_outputs)).collect(),
            bias: padded(&layer.bias, n_outputs).collect(),
            n_inputs: layer.weight.n_rows(),
        }
    }
}

fn padded(row: &[f32], n: usize) -> impl Iterator<Item = f32> {
    row.iter().copied().chain(std::iter::repeat(0.0)).take(n)
}

impl Engine {
    pub(crate) fn of(gel: &FastGel) -> Self {
        let layout = &gel.layout;
        let n_points = layout.grid.len();
        let mut pressure = Sparse::of(&gel.networks.pressure);
        let first = &gel.networks.pressure.rest.layers[0];
        let ports = gel.ports_mm.iter().map(|at| pressure.port(first, layout, *at));
        let ports = ports.collect();
        let wrench = Sparse::of(&gel.networks.wrench);
        let anywhere = Port {
            rows: (0..n_points)
                .map(|point| (point * wrench.nothing.len()) as u32)
                .collect(),
            bias: padded(&gel.networks.wrench.rest.layers[0].bias, wrench.n_hidden).collect(),
        };
        Self {
            pressure,
            ports,
            wrench,
            anywhere,
            n_points,
        }
    }

    pub(crate) fn scratch(&self) -> Scratch {
        let layers = self.pressure.rest.iter().chain(&self.wrench.rest);
        let widest = layers.map(|layer| layer.bias.len()).max().unwrap_or(0);
        let widest = widest.max(self.pressure.n_hidden).max(self.wrench.n_hidden);
        let n_features = self.pressure.nothing.len().max(self.wrench.nothing.len());
        Scratch {
            near: Vec::with_capacity(self.n_points),
            features: Vec::with_capacity(self.n_points * n_features),
            terms: Vec::with_capacity(self.n_points * n_features),
            hidden: [(); 2].map(|()| vec![0.0; widest]),
        }
    }

    /// From what touches to the pressure at each port, kPa, and force and torque. `[n_points * N_CHANNELS]` to `[n_taxels]` and 6.
    pub(crate) fn read(
        &self,
        inputs: &[f32],
        scratch: &mut Scratch,
        pressure_kpa: &mut [f32],
        wrench: &mut [f32; 6],
    ) {
        Arch::new().dispatch(Reading {
            engine: self,
            inputs,
            scratch,
            pressure_kpa,
            wrench,
        });
    }
}

impl Sparse {
    /// A port, with rows of its own where it is not on the grid: the inputs between the grid's points are linear.
    fn port(&mut self, first: &Linear, layout: &Layout, at: DVec2) -> Port {
        let (grid, n_hidden) = (&layout.grid, self.n_hidden);
        let n_features = self.nothing.len();
        let (cell, part) = grid.cell(at);
        let corners = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|corner: [i32; 2]| {
            let along = |axis: usize| {
                if corner[axis] == 1 {
                    part[axis]
                } else {
                    1.0 - part[axis]
                }
            };
            (corner, along(0) * along(1))
        });
        let is_on_grid = corners[0].1 > 1.0 - 1e-6;
        let mut rows = vec![NOWHERE; grid.len()];
        for (point, row) in rows.iter_mut().enumerate() {
            let of_point = [point % grid.n[0], point / grid.n[0]].map(|index| index as i32);
            let own = self.rows.len() / n_hidden;
            let mut sum = vec![0.0; n_features * n_hidden];
            let mut is_near = false;
            for (corner, share) in &corners {
                let offset = [0, 1].map(|axis| of_point[axis] - cell[axis] - corner[axis]);
                let Some(index) = layout.patch.offsets.iter().position(|known| *known == offset) else {
                    continue;
                };
                if *share < 1e-6 {
                    continue;
                }
                is_near = true;
                *row = (index * n_features) as u32;
                let from = index * n_features * n_hidden;
                for (sum, weight) in sum.iter_mut().zip(&self.rows[from..from + n_features * n_hidden]) {
                    *sum += *share as f32 * weight;
                }
            }
            if is_near && !is_on_grid {
                *row = own as u32;
                self.rows.extend(sum);
            }
        }
        // What describes the place does not change, nor does the finest mesh.
        let mut place = Vec::new();
        layout.surroundings.describe(grid, at, Turn::NONE, &mut place);
        let mut bias: Vec<f32> = padded(&first.bias, n_hidden).collect();
        let from = layout.patch.offsets.len() * n_features;
        for (value, weights) in place.iter().zip(first.weight.rows().skip(from)) {
            for (bias, weight) in bias.iter_mut().zip(weights) {
                *bias += value * weight;
            }
        }
        Port { rows, bias }
    }
}

/// One evaluation, compiled for each instruction set.
struct Reading<'a> {
    engine: &'a Engine,
    inputs: &'a [f32],
    scratch: &'a mut Scratch,
    pressure_kpa: &'a mut [f32],
    wrench: &'a mut [f32; 6],
}

impl WithSimd for Reading<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Scratch {
            near,
            features,
            terms,
            hidden,
        } = self.scratch;
        let points = self.inputs.as_chunks::<N_CHANNELS>().0;
        near.clear();
        for (number, channels) in points.iter().enumerate() {
            if channels.iter().any(|channel| *channel > 0.0) {
                near.push(number as u32);
            }
        }
        if near.is_empty() {
            self.pressure_kpa.fill(0.0);
            *self.wrench = [0.0; 6];
            return;
        }
        let engine = self.engine;
        engine.pressure.features(points, near, features);
        for (port, pressure_kpa) in engine.ports.iter().zip(self.pressure_kpa) {
            let output = engine.pressure.evaluate(port, near, features, terms, hidden);
            *pressure_kpa = PRESSURE_KPA * output[0];
        }
        engine.wrench.features(points, near, features);
        let output = engine
            .wrench
            .evaluate(&engine.anywhere, near, features, terms, hidden);
        for ((wrench, output), unit) in self.wrench.iter_mut().zip(output).zip(WRENCH) {
            *wrench = unit * output;
        }
    }
}

impl Sparse {
    /// Features of the points that something is near.
    #[inline(always)]
    fn features(&self, points: &[[f32; N_CHANNELS]], near: &[u32], features: &mut Vec<f32>) {
        features.clear();
        for point in near {
            let channels = &points[*point as usize];
            let first = features.len();
            features.extend_from_slice(&self.point.bias);
            let own = &mut features[first..];
            for (channel, weights) in channels.iter().zip(self.point.weight.rows()) {
                for (feature, weight) in own.iter_mut().zip(weights) {
                    *feature = channel.mul_add(*weight, *feature);
                }
            }
        }
        features.iter_mut().for_each(|feature| *feature = silu(*feature));
        for own in features.chunks_exact_mut(self.nothing.len()) {
            own.iter_mut()
                .zip(&self.nothing)
                .for_each(|(feature, nothing)| *feature -= nothing);
        }
    }

    #[inline(always)]
    fn evaluate<'a>(
        &self,
        port: &Port,
        near: &[u32],
        features: &[f32],
        terms: &mut Vec<(u32, f32)>,
        [hidden, next]: &'a mut [Vec<f32>; 2],
    ) -> &'a [f32] {
        terms.clear();
        for (point, features) in near.iter().zip(features.chunks_exact(self.nothing.len())) {
            let row = port.rows[*point as usize];
            if row == NOWHERE {
                continue;
            }
            terms.extend((row..).zip(features.iter().copied()));
        }
        sum_up(&port.bias, &self.rows, terms.iter().copied(), hidden);
        let (mut hidden, mut next) = (hidden, next);
        for layer in &self.rest {
            let units = &mut hidden[..layer.n_inputs];
            units.iter_mut().for_each(|value| *value = silu(*value));
            let terms = (0..).zip(units.iter().copied());
            sum_up(&layer.bias, &layer.weights, terms, next);
            (hidden, next) = (next, hidden);
        }
        &hidden[..]
    }
}

/// Adds multiples of rows to an offset. Each sum runs in the order of the terms, whatever the processor. `[n_rows][n]`
#[inline(always)]
fn sum_up(bias: &[f32], rows: &[f32], terms: impl Iterator<Item = (u32, f32)> + Clone, sums: &mut [f32]) {
    let n = bias.len();
    let mut first = 0;
    while first + LANES[0] <= n {
        sum_up_lanes::<{ LANES[0] }>(bias, rows, terms.clone(), sums, first);
        first += LANES[0];
    }
    while first + LANES[1] <= n {
        sum_up_lanes::<{ LANES[1] }>(bias, rows, terms.clone(), sums, first);
        first += LANES[1];
    }
}

#[inline(always)]
fn sum_up_lanes<const N: usize>(
    bias: &[f32],
    rows: &[f32],
    terms: impl Iterator<Item = (u32, f32)>,
    sums: &mut [f32],
    first: usize,
) {
    let mut own = [0.0; N];
    own.copy_from_slice(&bias[first..first + N]);
    for (row, factor) in terms {
        let from = row as usize * bias.len() + first;
        let row = &rows[from..from + N];
        for (sum, value) in own.iter_mut().zip(row) {
            *sum = factor.mul_add(*value, *sum);
        }
    }
    sums[first..first + N].copy_from_slice(&own);
}
