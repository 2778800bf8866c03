//! The networks of a surrogate.

use crate::network::LocalNetwork;

/// Pressure for an output of 1, kPa.
pub(crate) const PRESSURE_KPA: f32 = 50.0;

/// Force, N, and torque, N mm, for outputs of 1.
pub(crate) const WRENCH: [f32; 6] = [1.0, 1.0, 10.0, 30.0, 30.0, 10.0];

/// The trained networks.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Networks {
    /// From a patch to the pressure at its location.
    pub(crate) pressure: LocalNetwork,
    /// From the whole grid to force and torque.
    pub(crate) wrench: LocalNetwork,
    /// From the whole grid to the pressure at each taxel, for sensors with a port at the gel's
    /// side.
    pub(crate) taxels: Option<LocalNetwork>,
}
