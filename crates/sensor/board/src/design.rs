//! A board after placement and routing.

use crate::circuit::Circuit;
use crate::label::Label;
use crate::land::Placement;
use crate::outline::Outline;
use crate::pour::Pour;
use crate::route::Routed;

/// A complete board.
#[derive(Clone, Debug)]
pub(crate) struct Design {
    pub(crate) variant: String,
    pub(crate) circuit: Circuit,
    /// The placement of each part of the circuit.
    pub(crate) places: Vec<Placement>,
    pub(crate) outline: Outline,
    /// Names of nets, by number.
    pub(crate) nets: Vec<String>,
    pub(crate) routed: Routed,
    pub(crate) pour: Pour,
    pub(crate) labels: Vec<Label>,
}
