//! The networks as they are evaluated: only what touches is multiplied.

use std::collections::BTreeMap;

use glam::DVec2;
use pulp::{Arch, Simd, WithSimd};
use twintac_learn::Linear;

use crate::FastGel;
use crate::contact::N_CHANNELS;
use crate::layout::Layout;
use crate::network::{LocalNetwork, Turn, silu};
use crate::networks::{PRESSURE_KPA, WRENCH};

/// Outputs of a layer that are summed up side by side; layers are filled up with zeros to whole numbers of them.
const LANES: usize = 32;

/// Rows that go through a layer together.
const ROWS: usize = 2;

/// Points whose features are computed together.
const POINTS: usize = 8;

/// The networks of a fast gel, laid out for speed.
#[derive(Clone, Debug)]
pub(crate) struct Engine {
    pressure: Sparse,
    ports: Ports,
    wrench: Sparse,
    wrench_bias: Vec<f32>,
    n_points: usize,
}

/// A network most of whose points have nothing near them.
#[derive(Clone, Debug)]
struct Sparse {
    /// From the channels of a point to its features.
    point: Linear,
    /// Features of a point near which nothing is, which are taken off.
    nothing: Vec<f32>,
    /// The same for each of a few points. `[n_features * POINTS]`
    nothing_side_by_side: Vec<f32>,
    /// What the layer after the points adds for each unit of a feature. `[n_places * n_features][n_hidden]`
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

/// Where the ports are in the network of the pressure.
#[derive(Clone, Debug)]
struct Ports {
    /// What does not change of the layer after the points. `[n_taxels][n_hidden]`
    bias: Vec<f32>,
    /// Which ports have which points in their patches, point by point.
    uses: Vec<Use>,
    /// Where the uses of each point begin, and where those of the last one end. `[n_points + 1]`
    first_use: Vec<u32>,
    n: usize,
}

/// A port that has a point of the grid in its patch.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Use {
    /// Number of the place in the patch, whose rows multiply the features.
    place: u32,
    point: u32,
    port: u32,
}

/// What an evaluation writes to.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    /// The numbers of points that something is near.
    near: Vec<u32>,
    /// The features of these points, a few points side by side.
    features: Vec<[f32; POINTS]>,
    /// What goes into a layer, and out of it. `[n_taxels][n_units]`
    hidden: [Vec<f32>; 2],
    /// Whether something is in a port's patch.
    is_touched: Vec<bool>,
}

impl Sparse {
    fn of(network: &LocalNetwork) -> Self {
        let first = &network.rest.layers[0];
        let n_hidden = first.bias.len().next_multiple_of(LANES);
        let nothing = network.nothing();
        Self {
            point: network.point.clone(),
            nothing_side_by_side: nothing.iter().flat_map(|nothing| [*nothing; POINTS]).collect(),
            nothing,
            rows: padded_rows(first, n_hidden),
            n_hidden,
            rest: network.rest.layers[1..].iter().map(Dense::of).collect(),
        }
    }

    /// The rows of a place of the patch. `[n_features][n_hidden]`
    #[inline(always)]
    fn rows(&self, place: usize) -> &[f32] {
        let n = self.nothing.len() * self.n_hidden;
        &self.rows[place * n..(place + 1) * n]
    }
}

impl Dense {
    fn of(layer: &Linear) -> Self {
        let n_outputs = layer.bias.len().next_multiple_of(LANES);
        Self {
            weights: padded_rows(layer, n_outputs),
            bias: padded(&layer.bias, n_outputs).collect(),
            n_inputs: layer.weight.n_rows(),
        }
    }
}

fn padded_rows(layer: &Linear, n: usize) -> Vec<f32> {
    layer.weight.rows().flat_map(|row| padded(row, n)).collect()
}

fn padded(row: &[f32], n: usize) -> impl Iterator<Item = f32> {
    row.iter().copied().chain(std::iter::repeat(0.0)).take(n)
}

impl Engine {
    pub(crate) fn of(gel: &FastGel) -> Self {
        let mut pressure = Sparse::of(&gel.networks.pressure);
        let ports = Ports::of(gel, &mut pressure);
        let wrench = Sparse::of(&gel.networks.wrench);
        let bias = &gel.networks.wrench.rest.layers[0].bias;
        Self {
            wrench_bias: padded(bias, wrench.n_hidden).collect(),
            pressure,
            ports,
            wrench,
            n_points: gel.layout.grid.len(),
        }
    }

    pub(crate) fn scratch(&self) -> Scratch {
        let layers = self.pressure.rest.iter().chain(&self.wrench.rest);
        let widest = layers.map(|layer| layer.bias.len()).max().unwrap_or(0);
        let widest = widest.max(self.pressure.n_hidden).max(self.wrench.n_hidden);
        let n_features = self.pressure.nothing.len().max(self.wrench.nothing.len());
        let n_rows = self.ports.n.max(1);
        Scratch {
            near: Vec::with_capacity(self.n_points),
            features: vec![[0.0; POINTS]; self.n_points.div_ceil(POINTS) * n_features],
            hidden: [(); 2].map(|()| vec![0.0; n_rows * widest]),
            is_touched: vec![false; self.ports.n],
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

/// The rows of places between the grid's points: how far behind their cell they lie, in millionths of the spacing, and where the point lies from
/// the cell.
type RowsBetween = BTreeMap<([i64; 2], [i32; 2]), usize>;

impl Ports {
    /// The ports of a gel. One that is not on the grid gets rows of its own: the inputs between the grid's points are linear. Ports that lie
    /// equally far behind their cells share them.
    fn of(gel: &FastGel, network: &mut Sparse) -> Self {
        let layout = &gel.layout;
        let first = &gel.networks.pressure.rest.layers[0];
        let mut ports = Self {
            bias: Vec::new(),
            uses: Vec::new(),
            first_use: Vec::new(),
            n: gel.ports_mm.len(),
        };
        // Behind the patch come the rows of what describes a place, which no port needs here; rows of ports follow the patch.
        let n_own = network.nothing.len() * network.n_hidden;
        network.rows.truncate(layout.patch.offsets.len() * n_own);
        let mut between = RowsBetween::new();
        for (port, at) in gel.ports_mm.iter().enumerate() {
            ports.add(port as u32, *at, layout, network, &mut between);
            ports.bias.extend(bias_at(*at, layout, first, network));
        }
        ports.uses.sort_by_key(|pair| (pair.point, pair.port));
        let first_use = |point| ports.uses.partition_point(|pair| pair.point < point as u32) as u32;
        ports.first_use = (0..=layout.grid.len()).map(first_use).collect();
        ports
    }

    #[inline(always)]
    fn of_point(&self, point: usize) -> &[Use] {
        &self.uses[self.first_use[point] as usize..self.first_use[point + 1] as usize]
    }

    fn add(
        &mut self,
        port: u32,
        at: DVec2,
        layout: &Layout,
        network: &mut Sparse,
        between: &mut RowsBetween,
    ) {
        let (grid, patch) = (&layout.grid, &layout.patch);
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
        let corners = corners.into_iter().filter(|(_, share)| *share > 1e-6);
        let is_on_grid = part.length() < 1e-6;
        let n_own = network.nothing.len() * network.n_hidden;
        let behind = [part.x, part.y].map(|part| (1e6 * part).round() as i64);
        for point in 0..grid.len() {
            let of_point = [point % grid.n[0], point / grid.n[0]].map(|index| index as i32);
            let mut reached = corners.clone().filter_map(|(corner, share)| {
                let offset = [0, 1].map(|axis| of_point[axis] - cell[axis] - corner[axis]);
                let place = patch.offsets.iter().position(|known| *known == offset)?;
                Some((place, share as f32))
            });
            let from_cell = [0, 1].map(|axis| of_point[axis] - cell[axis]);
            let place = if is_on_grid {
                reached.next().map(|(place, _)| place)
            } else if let Some(known) = between.get(&(behind, from_cell)) {
                Some(*known)
            } else {
                let mut own = vec![0.0; n_own];
                let mut is_reached = false;
                for (place, share) in reached {
                    is_reached = true;
                    let rows = network.rows(place);
                    own.iter_mut()
                        .zip(rows)
                        .for_each(|(own, row)| *own += share * row);
                }
                is_reached.then(|| {
                    network.rows.extend(own);
                    let place = network.rows.len() / n_own - 1;
                    between.insert((behind, from_cell), place);
                    place
                })
            };
            self.uses.extend(place.map(|place| Use {
                place: place as u32,
                point: point as u32,
                port,
            }));
        }
    }
}

/// What describes a place does not change, nor does the finest mesh.
fn bias_at(at: DVec2, layout: &Layout, first: &Linear, network: &Sparse) -> Vec<f32> {
    let mut place = Vec::new();
    layout
        .surroundings
        .describe(&layout.grid, at, Turn::NONE, &mut place);
    let mut bias: Vec<f32> = padded(&first.bias, network.n_hidden).collect();
    let from = layout.patch.offsets.len() * network.nothing.len();
    for (value, weights) in place.iter().zip(first.weight.rows().skip(from)) {
        for (bias, weight) in bias.iter_mut().zip(weights) {
            *bias += value * weight;
        }
    }
    bias
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
        let Self {
            engine,
            inputs,
            scratch,
            pressure_kpa,
            wrench,
        } = self;
        let points = inputs.as_chunks::<N_CHANNELS>().0;
        scratch.near.clear();
        for (number, channels) in points.iter().enumerate() {
            // What is not near the surface is not near anything below it.
            if channels[0] > 0.0 {
                scratch.near.push(number as u32);
            }
        }
        if scratch.near.is_empty() {
            pressure_kpa.fill(0.0);
            *wrench = [0.0; 6];
            return;
        }
        engine.read_pressure(points, scratch, pressure_kpa);
        engine.read_wrench(points, scratch, wrench);
    }
}

impl Engine {
    #[inline(always)]
    fn read_pressure(&self, points: &[[f32; N_CHANNELS]], scratch: &mut Scratch, pressure_kpa: &mut [f32]) {
        let network = &self.pressure;
        let (n_features, n_hidden) = (network.nothing.len(), network.n_hidden);
        network.features(points, &scratch.near, &mut scratch.features);
        let hidden = &mut scratch.hidden[0][..self.ports.bias.len()];
        hidden.copy_from_slice(&self.ports.bias);
        scratch.is_touched.fill(false);
        for (near, point) in scratch.near.iter().enumerate() {
            for pair in self.ports.of_point(*point as usize) {
                let [place, port] = [pair.place, pair.port].map(|number| number as usize);
                scratch.is_touched[port] = true;
                let sums = &mut hidden[port * n_hidden..(port + 1) * n_hidden];
                add_products(near, &scratch.features, n_features, network.rows(place), sums);
            }
        }
        // Ports far from what touches are left out of the layers after that.
        let mut n_touched = 0;
        for port in 0..self.ports.n {
            if scratch.is_touched[port] {
                let own = port * n_hidden..(port + 1) * n_hidden;
                hidden.copy_within(own, n_touched * n_hidden);
                n_touched += 1;
            }
        }
        let (outputs, n_outputs) = network.finish(n_touched, &mut scratch.hidden);
        let mut outputs = outputs.chunks_exact(n_outputs);
        for (is_touched, pressure_kpa) in scratch.is_touched.iter().zip(pressure_kpa) {
            let output = if *is_touched { outputs.next() } else { None };
            *pressure_kpa = output.map_or(0.0, |output| PRESSURE_KPA * output[0]);
        }
    }

    #[inline(always)]
    fn read_wrench(&self, points: &[[f32; N_CHANNELS]], scratch: &mut Scratch, wrench: &mut [f32; 6]) {
        let network = &self.wrench;
        let n_features = network.nothing.len();
        network.features(points, &scratch.near, &mut scratch.features);
        let hidden = &mut scratch.hidden[0][..network.n_hidden];
        hidden.copy_from_slice(&self.wrench_bias);
        for (near, point) in scratch.near.iter().enumerate() {
            add_products(
                near,
                &scratch.features,
                n_features,
                network.rows(*point as usize),
                hidden,
            );
        }
        let (outputs, _) = network.finish(1, &mut scratch.hidden);
        for ((wrench, output), unit) in wrench.iter_mut().zip(outputs).zip(WRENCH) {
            *wrench = unit * output;
        }
    }
}

impl Sparse {
    /// Features of the points that something is near, a few points at a time. `[n_near / POINTS][n_features][POINTS]`
    #[inline(always)]
    fn features(&self, points: &[[f32; N_CHANNELS]], near: &[u32], features: &mut [[f32; POINTS]]) {
        let n_features = self.nothing.len();
        for (near, features) in near.chunks(POINTS).zip(features.chunks_exact_mut(n_features)) {
            let mut channels = [[0.0; POINTS]; N_CHANNELS];
            for (side, point) in near.iter().enumerate() {
                let point = &points[*point as usize];
                for channel in 0..N_CHANNELS {
                    channels[channel][side] = point[channel];
                }
            }
            for (feature, values) in features.iter_mut().enumerate() {
                *values = [self.point.bias[feature]; POINTS];
                for (channels, weights) in channels.iter().zip(self.point.weight.rows()) {
                    for (value, channel) in values.iter_mut().zip(channels) {
                        *value = channel.mul_add(weights[feature], *value);
                    }
                }
            }
            // Over slices whose length is not known when this is compiled: fixed ones are taken apart number by number.
            let values = features.as_flattened_mut().iter_mut();
            for (value, nothing) in values.zip(&self.nothing_side_by_side) {
                *value = silu(*value) - nothing;
            }
        }
    }

    /// The layers after the first. Returns the outputs of all rows, and how many places a row of them has.
    #[inline(always)]
    fn finish<'a>(&self, n_rows: usize, hidden: &'a mut [Vec<f32>; 2]) -> (&'a [f32], usize) {
        let [mut hidden, mut next] = {
            let [hidden, next] = hidden;
            [hidden, next]
        };
        let mut n_units = self.n_hidden;
        for layer in &self.rest {
            for value in &mut hidden[..n_rows * n_units] {
                *value = silu(*value);
            }
            layer.apply(n_rows, n_units, hidden, next);
            n_units = layer.bias.len();
            (hidden, next) = (next, hidden);
        }
        (&hidden[..n_rows * n_units], n_units)
    }
}

impl Dense {
    /// `[n_rows][n_units]` to `[n_rows][n_outputs]`; a row has the same bits however many there are.
    #[inline(always)]
    fn apply(&self, n_rows: usize, n_units: usize, inputs: &[f32], outputs: &mut [f32]) {
        let n_outputs = self.bias.len();
        let inputs = inputs[..n_rows * n_units].chunks(ROWS * n_units);
        for (inputs, outputs) in inputs.zip(outputs.chunks_mut(ROWS * n_outputs)) {
            if inputs.len() == ROWS * n_units {
                self.apply_rows::<ROWS>(n_units, inputs, outputs);
            } else {
                for (input, output) in inputs.chunks(n_units).zip(outputs.chunks_mut(n_outputs)) {
                    self.apply_rows::<1>(n_units, input, output);
                }
            }
        }
    }

    #[inline(always)]
    fn apply_rows<const N: usize>(&self, n_units: usize, inputs: &[f32], outputs: &mut [f32]) {
        let n_outputs = self.bias.len();
        let rows: [&[f32]; N] = std::array::from_fn(|row| &inputs[row * n_units..][..self.n_inputs]);
        for first in (0..n_outputs).step_by(LANES) {
            let mut sums = [[0.0; LANES]; N];
            for sums in &mut sums {
                sums.copy_from_slice(&self.bias[first..first + LANES]);
            }
            for (unit, weights) in self.weights.chunks_exact(n_outputs).enumerate() {
                let weights = &weights[first..first + LANES];
                for (sums, row) in sums.iter_mut().zip(rows) {
                    for (sum, weight) in sums.iter_mut().zip(weights) {
                        *sum = row[unit].mul_add(*weight, *sum);
                    }
                }
            }
            for (row, sums) in sums.iter().enumerate() {
                outputs[row * n_outputs + first..][..LANES].copy_from_slice(sums);
            }
        }
    }
}

/// Adds the rows of a place, each multiplied by a feature of a point, to sums, in the order of the rows. `[n_features][n]`, `[n]`
#[inline(always)]
fn add_products(near: usize, features: &[[f32; POINTS]], n_features: usize, rows: &[f32], sums: &mut [f32]) {
    let features = &features[near / POINTS * n_features..][..n_features];
    let side = near % POINTS;
    let n = sums.len();
    let (wide, narrow) = sums.as_chunks_mut::<{ 2 * LANES }>();
    for (number, sums) in wide.iter_mut().enumerate() {
        add_multiples(features, side, &rows[2 * LANES * number..], n, sums);
    }
    let first = n - narrow.len();
    for sums in narrow.as_chunks_mut::<LANES>().0 {
        add_multiples(features, side, &rows[first..], n, sums);
    }
}

#[inline(always)]
fn add_multiples<const N: usize>(
    features: &[[f32; POINTS]],
    side: usize,
    rows: &[f32],
    n: usize,
    sums: &mut [f32; N],
) {
    let mut own = *sums;
    for (number, feature) in features.iter().enumerate() {
        let factor = feature[side];
        let row = &rows[number * n..][..N];
        for (sum, value) in own.iter_mut().zip(row) {
            *sum = factor.mul_add(*value, *sum);
        }
    }
    *sums = own;
}
