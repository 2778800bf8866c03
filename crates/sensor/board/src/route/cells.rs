//! The grid points that are blocked by tracks which can still move.

use super::grid::{Grid, KINDS, STEP_MM, VIA, half_width, is_on};
use crate::rules::{CLEARANCE_MM, MARGIN_MM, VIA_TO_VIA_MM};
use crate::shapes::Shape;

/// Radius around a crossing in which the cost rises, mm: about the distance of two tracks.
const FOUGHT_MM: f64 = 0.25;

/// For each kind and node: how many paths block it, and how often it was crossed.
#[derive(Debug)]
pub(super) struct Cells {
    counts: [Vec<u16>; KINDS],
    fights: [Vec<u16>; KINDS],
}

impl Cells {
    pub(super) fn new(grid: &Grid) -> Self {
        Self {
            counts: std::array::from_fn(|_| vec![0; grid.len()]),
            fights: std::array::from_fn(|_| vec![0; grid.len()]),
        }
    }

    pub(super) fn add(&mut self, cells: &[(u8, u32)]) {
        for &(kind, node) in cells {
            self.counts[kind as usize][node as usize] += 1;
        }
    }

    pub(super) fn remove(&mut self, cells: &[(u8, u32)]) {
        for &(kind, node) in cells {
            self.counts[kind as usize][node as usize] -= 1;
        }
    }

    pub(super) fn is_taken(&self, kind: usize, node: usize) -> bool {
        self.counts[kind][node] > 0
    }

    pub(super) fn fights(&self, kind: usize, node: usize) -> u32 {
        u32::from(self.fights[kind][node])
    }

    /// Records that a path crossed others here. The cost also rises at neighbouring grid points, so
    /// that the next path keeps farther away than one grid point.
    pub(super) fn fought(&mut self, grid: &Grid, kind: usize, node: usize) {
        for near in grid.near(&Shape::disc(grid.at(node), 0.0), FOUGHT_MM) {
            let fights = &mut self.fights[kind][near];
            *fights = fights.saturating_add(1);
        }
    }
}

/// The kinds and nodes that a path blocks for other nets, each once.
pub(super) fn cells_of(grid: &Grid, tracks: &[(usize, Shape)], vias: &[Shape]) -> Vec<(u8, u32)> {
    let mut cells = Vec::new();
    let mut forbid = |kind: usize, shape: &Shape, reach: f64| {
        let nodes = grid.near(shape, reach + MARGIN_MM).into_iter();
        cells.extend(nodes.map(|node| (kind as u8, node as u32)));
    };
    for (layer, shape) in tracks {
        for kind in (0..KINDS).filter(|kind| is_on(*kind, *layer)) {
            forbid(kind, shape, half_width(kind) + CLEARANCE_MM);
        }
    }
    for via in vias {
        for kind in 0..KINDS {
            let reach = if kind == VIA {
                VIA_TO_VIA_MM - half_width(VIA)
            } else {
                half_width(kind) + CLEARANCE_MM
            };
            forbid(kind, via, reach);
        }
    }
    cells.sort_unstable();
    cells.dedup();
    cells
}

/// The nodes at which a via would be too close to one of these vias. The nodes of the vias
/// themselves are allowed.
pub(super) fn too_close_for_a_via(grid: &Grid, vias: &[usize]) -> Vec<usize> {
    let nodes = vias.iter().flat_map(|&via| {
        let own = Shape::disc(grid.at(via), 0.0);
        let near = grid.near(&own, VIA_TO_VIA_MM - 0.5 * STEP_MM);
        near.into_iter().filter(move |node| *node != via)
    });
    nodes.collect()
}
