//! The networks of a fast gel.

use crate::network::LocalNetwork;

/// What an output of 1 means, kPa.
pub(crate) const PRESSURE_KPA: f32 = 50.0;

/// What outputs of 1 mean: force, N, and torque, N mm.
pub(crate) const WRENCH: [f32; 6] = [1.0, 1.0, 10.0, 30.0, 30.0, 10.0];

/// The trained networks.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Networks {
    /// From a patch to the pressure at its place.
    pub(crate) pressure: LocalNetwork,
    /// From the whole grid to force and torque.
    pub(crate) wrench: LocalNetwork,
    /// From the whole grid to the pressure at each taxel, where patches do not tell it well.
    pub(crate) taxels: Option<LocalNetwork>,
}
