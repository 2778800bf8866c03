//! Evaluation of the networks: only points that something is near are multiplied, for a few sensors
//! together.

mod dense;
mod places;
mod product;
mod sparse;

use glam::DVec2;
use pulp::{Simd, WithSimd};
use twintac_learn::Linear;

use crate::FastGel;
use crate::contact::N_CHANNELS;
use crate::layout::Layout;
use crate::network::{LocalNetwork, Turn};
use crate::networks::{PRESSURE_KPA, WRENCH};
use crate::simd::dispatch;
use dense::padded;
use places::Places;
use sparse::{Near, Sparse};

/// Largest number of ports that are evaluated together, unless a single sensor has more.
const MOST_PORTS: usize = 64;

/// The networks of a surrogate, laid out for speed.
#[derive(Clone, Debug)]
pub(crate) struct Engine {
    pressure: Sparse,
    /// Whether one row holds all ports, instead of one row for each port.
    has_all_ports: bool,
    wrench: Sparse,
    n_points: usize,
    n_ports: usize,
}

/// Buffers of an evaluation.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    near: Near,
    pressure: sparse::Scratch,
    wrench: sparse::Scratch,
}

impl Engine {
    pub(crate) fn of(gel: &FastGel) -> Self {
        let (layout, networks) = (&gel.layout, &gel.networks);
        let (n_points, n_offsets) = (layout.n_points(), layout.patch.offsets.len());
        let of_patches = || {
            Sparse::of(&networks.pressure, n_offsets, |rows, [n_own, n_hidden]| {
                let places = Places::around(&gel.ports_mm, layout, rows, n_own);
                let first = &networks.pressure.rest.layers[0];
                let n_others = n_offsets * (n_own / n_hidden);
                let bias = |at: &DVec2| bias_at(*at, layout, first, n_others, n_hidden);
                (places, gel.ports_mm.iter().flat_map(bias).collect())
            })
        };
        let of_grid = |network: &LocalNetwork| {
            Sparse::of(network, layout.grid().len(), |_, [_, n_hidden]| {
                let bias = &network.rest.layers[0].bias;
                (Places::everywhere(layout), padded(bias, n_hidden).collect())
            })
        };
        Self {
            pressure: networks.taxels.as_ref().map_or_else(of_patches, of_grid),
            has_all_ports: networks.taxels.is_some(),
            wrench: of_grid(&networks.wrench),
            n_points,
            n_ports: gel.ports_mm.len(),
        }
    }

    /// Number of sensors that are evaluated together.
    pub(crate) fn n_together(&self) -> usize {
        (MOST_PORTS / self.n_ports.max(1)).max(1)
    }

    pub(crate) fn scratch(&self) -> Scratch {
        let n_sensors = self.n_together();
        let n_near = n_sensors * self.n_points;
        Scratch {
            near: Near {
                channels: vec![[0.0; N_CHANNELS]; n_near + 1],
                points: vec![0; n_near + 1],
                ends: Vec::with_capacity(n_sensors),
            },
            pressure: self.pressure.scratch(n_sensors, self.n_points),
            wrench: self.wrench.scratch(n_sensors, self.n_points),
        }
    }

    /// From network inputs to the pressure at each port, kPa, and force, N, and torque, N mm, of at
    /// most [`Self::n_together`] sensors. `[n_sensors][n_points * N_CHANNELS]` to
    /// `[n_sensors][n_ports]` and `[n_sensors]`. A sensor has the same bits whatever other sensors
    /// there are.
    pub(crate) fn read(
        &self,
        inputs: &[f32],
        scratch: &mut Scratch,
        pressure_kpa: &mut [f32],
        wrench: &mut [[f32; 6]],
    ) {
        dispatch(Reading {
            engine: self,
            inputs,
            scratch,
            pressure_kpa,
            wrench,
        });
    }
}

/// The bias of the first layer at a port. It contains the inputs that do not change: the
/// description of the location, and the finest mesh.
fn bias_at(at: DVec2, layout: &Layout, first: &Linear, n_others: usize, n_hidden: usize) -> Vec<f32> {
    let mut place = Vec::new();
    layout
        .surroundings
        .describe(layout.grid(), at, Turn::NONE, &mut place);
    let mut bias: Vec<f32> = padded(&first.bias, n_hidden).collect();
    for (value, weights) in place.iter().zip(first.weight.rows().skip(n_others)) {
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
    wrench: &'a mut [[f32; 6]],
}

impl WithSimd for Reading<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            engine,
            inputs,
            scratch,
            pressure_kpa,
            wrench,
        } = self;
        scratch.near.find(inputs, engine.n_points);
        let near = &scratch.near;
        let n_ports_of_row = if engine.has_all_ports { engine.n_ports } else { 1 };
        engine
            .pressure
            .read(simd, near, &mut scratch.pressure, |row, outputs| {
                let ports = &mut pressure_kpa[row * n_ports_of_row..][..n_ports_of_row];
                for (port, pressure_kpa) in ports.iter_mut().enumerate() {
                    *pressure_kpa = outputs.map_or(0.0, |outputs| PRESSURE_KPA * outputs[port]);
                }
            });
        engine
            .wrench
            .read(simd, near, &mut scratch.wrench, |sensor, outputs| {
                wrench[sensor] = [0.0; 6];
                for ((wrench, output), unit) in
                    wrench[sensor].iter_mut().zip(outputs.unwrap_or(&[])).zip(WRENCH)
                {
                    *wrench = unit * output;
                }
            });
    }
}

impl Near {
    /// Collects the points that something is near.
    #[inline(always)]
    fn find(&mut self, inputs: &[f32], n_points: usize) {
        self.ends.clear();
        let mut n_near = 0;
        for sensor in inputs.as_chunks::<N_CHANNELS>().0.chunks_exact(n_points) {
            for (number, channels) in sensor.iter().enumerate() {
                // A body that is out of reach of the surface is out of reach of the deeper levels
                // too. An entry of a point out of reach is overwritten by the next point.
                self.channels[n_near] = *channels;
                self.points[n_near] = number as u32;
                n_near += usize::from(channels[0] > 0.0);
            }
            self.ends.push(n_near);
        }
    }
}
