//! A*: the cheapest path from one piece of a net to any other.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::cells::{Cells, too_close_for_a_via};
use super::grid::{Fixed, Grid, VIA, track_kind};
use super::net::{Net, Spot};

/// Costs: a step of 0.1 mm along an axis costs 10.
const STRAIGHT: u32 = 10;
const DIAGONAL: u32 = 14;
/// Cost of a bend of 45°. Sharper bends are not allowed.
const BEND: u32 = 12;
/// Cost of a bend so close to copper of the same net that a stub is left.
const STUB: u32 = 400;
/// Cost of a via.
const THROUGH: u32 = 160;
/// Cost of a step through an area of another net, and the additional cost for each earlier crossing
/// there.
const CROSSING: u32 = 40;
const FIGHT: u32 = 6;

/// The eight directions, counter-clockwise.
const DIRECTIONS: [(i64, i64); 8] = [
    (1, 0),
    (1, 1),
    (0, 1),
    (-1, 1),
    (-1, 0),
    (-1, -1),
    (0, -1),
    (1, -1),
];
/// No direction yet: at a start or at a via.
const NONE: usize = 8;
const WAYS: usize = 9;

/// The data of a search.
pub(super) struct Search<'a> {
    pub(super) grid: &'a Grid,
    pub(super) fixed: &'a Fixed,
    /// The cells, without the net's own paths.
    pub(super) cells: &'a Cells,
    /// Whether tracks of other nets may be crossed, at a cost.
    pub(super) may_cross: bool,
}

/// Memory that searches reuse.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    costs: Vec<u32>,
    /// States with a cost. All other states have the largest cost.
    touched: Vec<usize>,
    /// The state that each state was reached from, by index.
    from: Vec<u32>,
    is_target: Vec<bool>,
    no_via: Vec<bool>,
    /// By layer and node: whether copper of the same net is so near that a bend leaves a stub
    /// shorter than a track's width.
    near_own: Vec<bool>,
}

struct Targets {
    low: (i64, i64),
    high: (i64, i64),
}

impl Search<'_> {
    /// The cheapest path from `starts` to `targets`, and its cost, crossings included.
    pub(super) fn way(
        &self,
        net: &Net,
        starts: &[Spot],
        targets: &[Spot],
        scratch: &mut Scratch,
    ) -> Option<(Vec<Spot>, u32)> {
        let nodes = self.grid.len();
        self.prepare(net, [starts, targets], scratch);
        let box_of_targets = self.mark(targets, scratch);
        let mut open = BinaryHeap::new();
        for &(layer, node) in starts {
            let state = (usize::from(layer) * nodes + node as usize) * WAYS + NONE;
            scratch.costs[state] = 0;
            scratch.touched.push(state);
            scratch.from[state] = u32::MAX;
            open.push(Reverse((self.ahead(&box_of_targets, node as usize), state)));
        }
        while let Some(Reverse((estimate, state))) = open.pop() {
            let (spot, way) = (state / WAYS, state % WAYS);
            let (layer, node) = (spot / nodes, spot % nodes);
            let cost = scratch.costs[state];
            if estimate > cost + self.ahead(&box_of_targets, node) {
                continue;
            }
            if scratch.is_target[spot] {
                return Some(self.trace(state, scratch));
            }
            let bend = if scratch.near_own[spot] { STUB } else { BEND };
            let mut reach = |next: usize, next_cost: u32| {
                if next_cost < scratch.costs[next] {
                    scratch.costs[next] = next_cost;
                    scratch.touched.push(next);
                    scratch.from[next] = state as u32;
                    let next_node = next / WAYS % nodes;
                    open.push(Reverse((
                        next_cost + self.ahead(&box_of_targets, next_node),
                        next,
                    )));
                }
            };
            self.steps(net, (layer, node, way), cost, bend, &mut reach);
            let other = (1 - layer) * nodes + node;
            if way != NONE
                && !scratch.no_via[node]
                && let Some(price) = self.price(VIA, node, net)
            {
                reach(other * WAYS + NONE, cost + THROUGH + 3 * price);
            }
        }
        None
    }

    /// Clears the last search, and marks where vias and bends are unwanted.
    fn prepare(&self, net: &Net, own: [&[Spot]; 2], scratch: &mut Scratch) {
        let nodes = self.grid.len();
        for state in scratch.touched.drain(..) {
            scratch.costs[state] = u32::MAX;
        }
        scratch.costs.resize(2 * nodes * WAYS, u32::MAX);
        scratch.from.resize(2 * nodes * WAYS, 0);
        scratch.is_target.clear();
        scratch.is_target.resize(2 * nodes, false);
        scratch.no_via.clear();
        scratch.no_via.resize(nodes, false);
        let own_vias: Vec<usize> = net.paths.iter().flat_map(|path| path.via_nodes()).collect();
        for node in too_close_for_a_via(self.grid, &own_vias) {
            scratch.no_via[node] = true;
        }
        scratch.near_own.clear();
        scratch.near_own.resize(2 * nodes, false);
        let (columns, rows) = (self.grid.columns, self.grid.rows);
        let reach = if net.is_power { 3 } else { 2 };
        for &(layer, node) in own.into_iter().flatten() {
            let (column, row) = (node as usize % columns, node as usize / columns);
            for row in row.saturating_sub(reach)..=(row + reach).min(rows - 1) {
                let first = usize::from(layer) * nodes + row * columns;
                let (from, to) = (column.saturating_sub(reach), (column + reach).min(columns - 1));
                scratch.near_own[first + from..=first + to].fill(true);
            }
        }
    }

    fn steps(
        &self,
        net: &Net,
        (layer, node, way): (usize, usize, usize),
        cost: u32,
        bend_cost: u32,
        reach: &mut impl FnMut(usize, u32),
    ) {
        let (columns, rows) = (self.grid.columns as i64, self.grid.rows as i64);
        let (x, y) = (node as i64 % columns, node as i64 / columns);
        for (next_way, (along, up)) in DIRECTIONS.into_iter().enumerate() {
            let turn = if way == NONE { 0 } else { (next_way + 8 - way) % 8 };
            let bend = match turn {
                0 => 0,
                1 | 7 => bend_cost,
                _ => continue,
            };
            let (next_x, next_y) = (x + along, y + up);
            if !(0..columns).contains(&next_x) || !(0..rows).contains(&next_y) {
                continue;
            }
            let next = (next_y * columns + next_x) as usize;
            let Some(price) = self.price(track_kind(net.is_power, layer), next, net) else {
                continue;
            };
            let step = if next_way % 2 == 0 { STRAIGHT } else { DIAGONAL };
            let state = (layer * self.grid.len() + next) * WAYS + next_way;
            reach(state, cost + step + bend + price);
        }
    }

    /// Cost of being there, in addition to the path itself. `None` if it is not allowed.
    fn price(&self, kind: usize, node: usize, net: &Net) -> Option<u32> {
        if !self.fixed.allows(kind, node, net.number) {
            return None;
        }
        if !self.cells.is_taken(kind, node) {
            return Some(0);
        }
        self.may_cross
            .then(|| CROSSING + FIGHT * self.cells.fights(kind, node))
    }

    fn mark(&self, targets: &[Spot], scratch: &mut Scratch) -> Targets {
        let columns = self.grid.columns as i64;
        let mut found = Targets {
            low: (i64::MAX, i64::MAX),
            high: (i64::MIN, i64::MIN),
        };
        for &(layer, node) in targets {
            scratch.is_target[usize::from(layer) * self.grid.len() + node as usize] = true;
            let (x, y) = (i64::from(node) % columns, i64::from(node) / columns);
            found.low = (found.low.0.min(x), found.low.1.min(y));
            found.high = (found.high.0.max(x), found.high.1.max(y));
        }
        found
    }

    /// A lower bound for the cost of the path to the box around the targets.
    fn ahead(&self, targets: &Targets, node: usize) -> u32 {
        let columns = self.grid.columns as i64;
        let (x, y) = (node as i64 % columns, node as i64 / columns);
        let along = (targets.low.0 - x).max(x - targets.high.0).max(0) as u32;
        let up = (targets.low.1 - y).max(y - targets.high.1).max(0) as u32;
        let diagonal = along.min(up);
        DIAGONAL * diagonal + STRAIGHT * (along.max(up) - diagonal)
    }

    fn trace(&self, end: usize, scratch: &Scratch) -> (Vec<Spot>, u32) {
        let nodes = self.grid.len();
        let mut spots = Vec::new();
        let mut state = end;
        loop {
            let spot = state / WAYS;
            spots.push(((spot / nodes) as u8, (spot % nodes) as u32));
            let from = scratch.from[state];
            if from == u32::MAX {
                break;
            }
            state = from as usize;
        }
        spots.reverse();
        (spots, scratch.costs[end])
    }
}
