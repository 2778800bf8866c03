//! What gels are made of: their constants, and what the energy of a deformation is.
//!
//! A [`Material`] has a [`Model`], the answer to a change of shape, a bulk modulus, and a Prony series of what fades. Each model is a file of
//! its own in this crate: a struct of constants that is [`Elastic`], and its law. A law's energy per volume at rest is
//! `W(I1, I2, J) + Σ f(ln λ̄)`: a function of the invariants of the deformation ([`Law`]; [`IsochoricLaw`] where only the change of shape counts),
//! and one of the isochoric principal stretches ([`StretchLaw`]). Laws are evaluated for eight points side by side ([`wide`]).
//!
//! The body's resistance to a change of volume, `κ/2 (θ - 1)²` with a volume ratio `θ` averaged over a neighbourhood, comes on top and is the
//! solver's; see [`Elastic::volume_modulus_kpa`].

mod elastic;
mod error;
mod invariants;
mod law;
mod material;
mod model;
mod stretches;
pub mod wide;

pub use elastic::Elastic;
pub use error::MaterialError;
pub use invariants::{Curvatures, Invariants, Slopes};
pub use law::{Isochoric, IsochoricLaw, Law, LawProperties};
pub use material::{Material, PronyTerm};
pub use model::*;
pub use stretches::{NoStretches, StretchLaw, StretchSlopes, Stretches};
