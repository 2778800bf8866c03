//! The router connects the pads of each net by tracks and vias on two layers.
//!
//! A* on a grid of 0.1 mm finds the cheapest path from one piece of a net to another ([`search`]).
//! For each grid point it is known beforehand what is near copper of other nets ([`grid`]). A path
//! may cross tracks of other nets at a cost. Those tracks are then removed and routed again later,
//! and crossing at this point costs more from then on ([`router`]). At the end each net is routed
//! once more with all others in place, which removes detours ([`tidy`]). The order of all steps is
//! fixed: the same board results each time.

mod cells;
mod grid;
mod net;
mod router;
mod run;
mod search;
mod tidy;

use glam::DVec2;

use crate::land::Side;
use crate::rules::VIA_MM;
use crate::shapes::Shape;

pub(crate) use grid::Grid;
pub(crate) use run::route;

/// Copper that exists before routing.
#[derive(Clone, Debug)]
pub(crate) struct PadCopper {
    pub(crate) shape: Shape,
    pub(crate) side: Side,
    /// Its net. `None`: no track may touch it.
    pub(crate) net: Option<usize>,
    /// Whether tracks of its net have to reach it.
    pub(crate) is_pin: bool,
}

/// A straight track.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Track {
    pub(crate) net: usize,
    pub(crate) side: Side,
    pub(crate) from: DVec2,
    pub(crate) to: DVec2,
    pub(crate) width: f64,
}

impl Track {
    pub(crate) fn shape(&self) -> Shape {
        Shape::Capsule {
            from: self.from,
            to: self.to,
            radius: 0.5 * self.width,
        }
    }
}

/// A via through both layers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Via {
    pub(crate) net: usize,
    pub(crate) at: DVec2,
}

impl Via {
    pub(crate) fn shape(&self) -> Shape {
        Shape::disc(self.at, 0.5 * VIA_MM)
    }
}

/// The result of the router.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Routed {
    pub(crate) tracks: Vec<Track>,
    pub(crate) vias: Vec<Via>,
}
