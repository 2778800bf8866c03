//! Hyperelastic materials of gels: their constants, and the strain energy of a deformation with its
//! derivatives.
//!
//! A [`Material`] consists of a [`Model`] of its elastic response to a change of shape, a bulk
//! modulus in kPa, and a Prony series of its relaxation (time constants in s). Input: the
//! constants, from a file or from code, and the invariants or principal stretches of a deformation.
//! Output: strain energies per undeformed volume in kPa, and their first and second derivatives,
//! for the finite elements of the solver.
//!
//! - [`Model`]: the models, one file each in `src/model`: neo-Hookean, Mooney-Rivlin, Yeoh, Ogden,
//!   and two compressible neo-Hookean laws.
//! - [`Law`] and [`StretchLaw`]: what the solver evaluates.
//! - [`wide`]: eight numbers side by side; laws are evaluated for eight points at a time.
//!
//! # How it works
//!
//! The energy density is `W(I1, I2, J) + Σ f(ln λ̄)`: a function of the invariants of the
//! deformation ([`Law`]), and one of the isochoric principal stretches ([`StretchLaw`]). Laws that
//! depend only on the change of shape are written in `Ī1` and `Ī2` (`IsochoricLaw`) or in stretches
//! ([`StretchLaw`]: Ogden). The kernels of the solver are compiled once for all laws. They call the
//! law for all points of eight tetrahedra at a time, and its [`LawProperties`] say which terms they
//! can leave out.
//!
//! The solver adds the term `κ/2 (θ - 1)²` to every law. Its volume ratio `θ` is averaged around
//! the nodes of the coarse mesh, which prevents volumetric locking.
//!
//! - A law that is not isochoric has a hydrostatic stress of its own, of the order of the shear
//!   modulus. It states which `κ` gives the requested bulk modulus at small strain
//!   ([`Model::volume_modulus_kpa`]). The reported pressure is the sum of both parts, averaged in
//!   the same way. Relaxation is not defined for such a law: a Prony series beside it is an error.
//! - Principal axes are found by Jacobi rotations (in the solver). Difference quotients of close
//!   stretches are evaluated by a series, so equal stretches are no special case.
//! - The stable neo-Hookean law allows a Newton step to pass through inverted tetrahedra. An
//!   equilibrium with an inverted tetrahedron is an error for every law.
//!
//! # A new material
//!
//! A new material is one file in `src/model` and two lines in the `mod.rs` beside it: its module,
//! and its type with the name that files use for it. Sensor descriptions and `materials/*.toml`
//! then give its constants by the names of its fields. Its `Elastic::example` includes it in the
//! tests that all models have to pass ([`Model::examples`]); its closed form goes into
//! `crates/gel/softbody/tests/closed_forms.rs`.
//!
//! `twintac calibrate` finds its constants by the names of its fields, and needs no new line. A
//! press with friction cannot be differentiated by the constants of a material: its forces are
//! compared with the measured ones, but the derivatives are those of the same press without
//! friction. The derivative by the friction coefficient is a difference quotient.
//!
//! This crate depends on no other crate of the workspace: it knows no sensors, meshes, solvers or
//! files.

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
