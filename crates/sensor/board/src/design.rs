//! What a board consists of, once it is placed and routed.

use crate::circuit::Circuit;
use crate::label::Label;
use crate::land::Placement;
use crate::outline::Outline;
use crate::pour::Pour;
use crate::route::Routed;

/// A board, all of it.
#[derive(Clone, Debug)]
pub(crate) struct Design {
    pub(crate) variant: String,
    pub(crate) circuit: Circuit,
    /// Where each part of the circuit is.
    pub(crate) places: Vec<Placement>,
    pub(crate) outline: Outline,
    /// Names of nets by number.
    pub(crate) nets: Vec<String>,
    pub(crate) routed: Routed,
    pub(crate) pour: Pour,
    pub(crate) labels: Vec<Label>,
}
