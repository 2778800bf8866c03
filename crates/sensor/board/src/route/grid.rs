//! The grid, and the grid points near copper that cannot move.

use glam::DVec2;

use super::PadCopper;
use crate::land::Side;
use crate::outline::Outline;
use crate::rules::{
    CLEARANCE_MM, EDGE_CLEARANCE_MM, MARGIN_MM, POWER_WIDTH_MM, SIGNAL_WIDTH_MM, VIA_MM, VIA_TO_PAD_MM,
};
use crate::shapes::Shape;

/// Distance of grid points, mm.
pub(super) const STEP_MM: f64 = 0.1;

/// The kinds of copper at a grid point: a signal track on top or bottom, a power track on top or
/// bottom, a via.
pub(super) const KINDS: usize = 5;
pub(super) const VIA: usize = 4;

/// The kind of a track.
pub(super) fn track_kind(is_power: bool, layer: usize) -> usize {
    2 * usize::from(is_power) + layer
}

/// Half the width of a kind, mm.
pub(super) fn half_width(kind: usize) -> f64 {
    0.5 * match kind {
        0 | 1 => SIGNAL_WIDTH_MM,
        2 | 3 => POWER_WIDTH_MM,
        _ => VIA_MM,
    }
}

/// Whether a kind is on a layer.
pub(super) fn is_on(kind: usize, layer: usize) -> bool {
    kind == VIA || kind % 2 == layer
}

pub(super) fn layer_of(side: Side) -> usize {
    usize::from(side == Side::Bottom)
}

pub(super) fn side_of(layer: usize) -> Side {
    if layer == 0 { Side::Top } else { Side::Bottom }
}

/// The grid.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    pub(crate) origin: DVec2,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl Grid {
    pub(crate) fn over(outline: &Outline) -> Self {
        let bounds = outline.bounds();
        let size = (bounds.size() / STEP_MM).ceil();
        Self {
            origin: bounds.min,
            columns: size.x as usize + 1,
            rows: size.y as usize + 1,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.columns * self.rows
    }

    pub(crate) fn at(&self, node: usize) -> DVec2 {
        let (column, row) = (node % self.columns, node / self.columns);
        self.origin + STEP_MM * DVec2::new(column as f64, row as f64)
    }

    /// Nodes whose distance to a shape is less than `reach`, mm.
    pub(crate) fn near(&self, shape: &Shape, reach: f64) -> Vec<usize> {
        let (min, max) = shape.bounds();
        let low = ((min - reach - self.origin) / STEP_MM).floor().max(DVec2::ZERO);
        let high = ((max + reach - self.origin) / STEP_MM).ceil().max(DVec2::ZERO);
        let columns = low.x as usize..(high.x as usize + 1).min(self.columns);
        let rows = low.y as usize..(high.y as usize + 1).min(self.rows);
        let nodes = rows.flat_map(|row| columns.clone().map(move |column| row * self.columns + column));
        nodes
            .filter(|&node| shape.distance(self.at(node)) < reach)
            .collect()
    }

    /// The nodes next to a point; only one if the point is on the grid.
    pub(crate) fn next_to(&self, point: DVec2) -> Vec<usize> {
        let place = (point - self.origin) / STEP_MM;
        let near = |value: f64| {
            let low = (value - 0.501).ceil();
            (low as i64..=(value + 0.501).floor() as i64)
                .filter_map(|index| usize::try_from(index).ok())
                .collect::<Vec<_>>()
        };
        let columns = near(place.x);
        let rows = near(place.y).into_iter();
        let nodes = rows.flat_map(|row| columns.iter().map(move |column| (row, *column)));
        nodes
            .filter(|&(row, column)| row < self.rows && column < self.columns)
            .map(|(row, column)| row * self.columns + column)
            .collect()
    }
}

/// No net may be there.
const NOBODY: u16 = u16::MAX;

/// For each kind and node: 0 if every net may be there; a net's number plus 1 if only this net may.
#[derive(Debug)]
pub(super) struct Fixed {
    owners: [Vec<u16>; KINDS],
}

impl Fixed {
    pub(super) fn new(grid: &Grid, outline: &Outline, pads: &[PadCopper]) -> Self {
        let mut fixed = Self {
            owners: std::array::from_fn(|_| vec![0; grid.len()]),
        };
        for node in 0..grid.len() {
            let inside = outline.inside_mm(grid.at(node));
            for kind in 0..KINDS {
                if inside < half_width(kind) + EDGE_CLEARANCE_MM + MARGIN_MM {
                    fixed.owners[kind][node] = NOBODY;
                }
            }
        }
        for screw in outline.screws() {
            for kind in 0..KINDS {
                for node in grid.near(&screw, half_width(kind) + MARGIN_MM) {
                    fixed.owners[kind][node] = NOBODY;
                }
            }
        }
        for pad in pads {
            fixed.add(grid, pad);
        }
        fixed
    }

    fn add(&mut self, grid: &Grid, pad: &PadCopper) {
        let owner = pad.net.map_or(NOBODY, |net| net as u16 + 1);
        let layer = layer_of(pad.side);
        for kind in (0..KINDS).filter(|kind| is_on(*kind, layer)) {
            for node in grid.near(&pad.shape, half_width(kind) + CLEARANCE_MM + MARGIN_MM) {
                self.own(kind, node, owner);
            }
        }
        for node in grid.near(&pad.shape, half_width(VIA) + VIA_TO_PAD_MM) {
            self.own(VIA, node, NOBODY);
        }
    }

    fn own(&mut self, kind: usize, node: usize, owner: u16) {
        let place = &mut self.owners[kind][node];
        *place = if *place == 0 || *place == owner {
            owner
        } else {
            NOBODY
        };
    }

    /// Whether a net may have copper of this kind there.
    pub(super) fn allows(&self, kind: usize, node: usize, net: usize) -> bool {
        let owner = self.owners[kind][node];
        owner == 0 || usize::from(owner) == net + 1
    }
}
