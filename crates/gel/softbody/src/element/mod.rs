//! The elements: tetrahedra with a linear pressure, and displacements of twice the resolution.
//!
//! Every coarse tetrahedron has ten nodes: its corners and the midpoints of its edges. An element
//! is a set of quadrature points inside of it, with the shape functions of displacements and
//! pressures there. With volumes `V`, gradients `G` of the shape functions and
//! `F = 1 + Σ u_a ⊗ G_a`, the energy is `Σ V W(F) + ½ Σ_c κ g_c²/m_c`. Here `g_c = Σ w_c V (J - 1)`
//! is the volume change of a corner `c`, `w_c` its weight at each point, and `m_c = Σ w_c V` its
//! volume. The pressure of a corner is `p_c = -κ g_c/m_c`. This is a mixed formulation with a
//! lumped mass matrix of the pressures, from which the pressures are eliminated.
//!
//! Kernels work on packs of eight tetrahedra. They are compiled once for all materials: [`law`]
//! evaluates the material's law for all points of a pack at once.

mod composite;
mod deformation;
mod elements;
mod folding;
mod forces;
mod law;
mod layered;
mod principal;
mod quadratic;
mod response;
mod spectral;
mod stress;
mod table;
mod tangent;

pub use elements::Element;
pub(crate) use elements::{Elements, Side};
pub(crate) use forces::{Forces, Volumes};
pub(crate) use response::Response;
pub(crate) use stress::{hydrostatic_shares, mean_deviators, update_history};
pub(crate) use table::{EDGES, NODES, Table};
pub(crate) use tangent::{CoarseSink, CoarseTangent, NodeBlock, NodeSlopes, Sink};

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
mod tests;
