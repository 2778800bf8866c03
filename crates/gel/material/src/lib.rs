//! Materials of gels: their constants, and the energy of a deformation.
//!
//! A [`Material`] has a [`Model`] of its elastic response to a change of shape, a bulk modulus, and a Prony series of its relaxation. Each model is a
//! file of its own: a struct of constants that is `Elastic`, and its law. A law's energy per volume at rest is
//! `W(I1, I2, J) + Σ f(ln λ̄)`: a function of the invariants of the deformation ([`Law`]; `IsochoricLaw` if it depends on the change of shape alone),
//! and one of the isochoric principal stretches ([`StretchLaw`]). Laws are evaluated for eight points side by side ([`wide`]).
//!
//! The solver adds the resistance to a change of volume: `κ/2 (θ - 1)²` with a volume ratio `θ` averaged over a neighbourhood; see
//! [`Model::volume_modulus_kpa`].

mod elastic;
mod error;
mod invariants;
mod isochoric;
mod law;
mod material;
mod model;
mod stretch_law;
mod stretches;
pub mod wide;

use elastic::Elastic;
pub use error::MaterialError;
pub use invariants::{Curvatures, Invariants, Slopes};
pub use law::{Law, LawProperties};
pub use material::{Material, PronyTerm};
pub use model::*;
pub use stretch_law::{StretchLaw, StretchSlopes};
