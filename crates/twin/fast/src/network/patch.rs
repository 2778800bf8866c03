//! The part of the grid around a location of the gel's base, and the location itself, as inputs of
//! a network.

use glam::DVec2;
use serde::{Deserialize, Serialize};
use twintac_sensor::Sensor;

use crate::contact::N_CHANNELS;
use crate::surface::SurfaceGrid;

/// Radius of a patch as a fraction of the gel's height: bodies farther away have little effect.
const REACH_OF_HEIGHT: f64 = 0.94;

/// Smallest radius of a patch, in points of the grid.
const LEAST_REACH: i32 = 4;

/// Decay length of the effect of the gel's edges, as a fraction of the gel's height.
const EDGE_DECAY: f64 = 0.5;

/// Number of inputs that describe a location.
const N_PLACE: usize = 13;

/// Offsets of a patch's points from its location, in points of the grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Patch {
    pub(crate) offsets: Vec<[i32; 2]>,
}

/// A symmetry of the square: axes swapped or not, then each mirrored or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turn {
    pub(crate) swapped: bool,
    pub(crate) mirrored: [bool; 2],
}

impl Patch {
    /// All points of a grid within the radius, over a gel of this height.
    pub(crate) fn round(grid: &SurfaceGrid, height_mm: f64) -> Self {
        let reach = (REACH_OF_HEIGHT * height_mm / grid.spacing_mm).round() as i32;
        let reach = reach.max(LEAST_REACH);
        let within = |[i, j]: &[i32; 2]| i * i + j * j <= reach * reach + 1;
        let all = (-reach..=reach).flat_map(|j| (-reach..=reach).map(move |i| [i, j]));
        Self {
            offsets: all.filter(within).collect(),
        }
    }

    /// Number of inputs of a network: the patch, the description of the location, and the
    /// coarseness of the mesh.
    pub(crate) fn n_inputs(&self) -> usize {
        self.offsets.len() * N_CHANNELS + N_PLACE + 1
    }

    /// For each offset, transformed by `turn`, the point of the grid at that offset from a location
    /// on the grid; `None` beside the grid.
    pub(crate) fn points<'a>(
        &'a self,
        grid: &'a SurfaceGrid,
        place: [i32; 2],
        turn: Turn,
    ) -> impl Iterator<Item = Option<usize>> + 'a {
        self.offsets.iter().map(move |offset| {
            let offset = turn.apply(*offset);
            grid.point([place[0] + offset[0], place[1] + offset[1]])
        })
    }
}

impl Turn {
    /// The identity.
    pub(crate) const NONE: Self = Self {
        swapped: false,
        mirrored: [false; 2],
    };

    /// The symmetry of a number from 0 to 7.
    pub(crate) fn number(number: u32) -> Self {
        Self {
            swapped: number & 4 != 0,
            mirrored: [number & 1 != 0, number & 2 != 0],
        }
    }

    /// The offset in the gel of an offset of the transformed patch.
    fn apply(self, [i, j]: [i32; 2]) -> [i32; 2] {
        let [mut i, mut j] = if self.swapped { [j, i] } else { [i, j] };
        if self.mirrored[0] {
            i = -i;
        }
        if self.mirrored[1] {
            j = -j;
        }
        [i, j]
    }
}

/// The extent of the gel, from which locations of its base are described.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Surroundings {
    low_mm: DVec2,
    high_mm: DVec2,
    height_mm: f64,
}

impl Surroundings {
    pub(crate) fn of(sensor: &Sensor) -> Self {
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        Self {
            low_mm: low.truncate(),
            high_mm: high.truncate(),
            height_mm: high.z - low.z,
        }
    }

    /// Height of the gel, mm.
    pub(crate) fn height_mm(&self) -> f64 {
        self.height_mm
    }

    /// Root of the gel's area in plan, mm.
    pub(crate) fn width_mm(&self) -> f64 {
        (self.high_mm - self.low_mm).element_product().sqrt()
    }

    /// The gel's lowest corner in plan, mm.
    pub(crate) fn low_mm(&self) -> DVec2 {
        self.low_mm
    }

    /// Appends the description of a location of the gel's base, seen from a transformed patch: how
    /// close each edge of the gel is, and how much lower the gel is than at its highest point,
    /// above the location and to each side.
    pub(crate) fn describe(&self, grid: &SurfaceGrid, at: DVec2, turn: Turn, inputs: &mut Vec<f32>) {
        let lower = |at: DVec2| 1.0 - grid.height_mm_at(at) / self.height_mm;
        let mut near = Vec::with_capacity(4);
        let mut sides = Vec::with_capacity(4);
        for axis in 0..2 {
            let from = if turn.swapped { 1 - axis } else { axis };
            for is_high in [turn.mirrored[from], !turn.mirrored[from]] {
                let (distance_mm, way) = if is_high {
                    (self.high_mm[from] - at[from], 1.0)
                } else {
                    (at[from] - self.low_mm[from], -1.0)
                };
                near.push((-distance_mm.max(0.0) / (EDGE_DECAY * self.height_mm)).exp() as f32);
                let mut side = at;
                side[from] += way * EDGE_DECAY * self.height_mm;
                sides.push(lower(side) as f32);
            }
        }
        inputs.extend(&near);
        inputs.extend(near.iter().map(|near| near * near));
        inputs.push(lower(at) as f32);
        inputs.extend(sides);
    }
}
