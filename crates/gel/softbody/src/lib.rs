//! Finite-strain FEM of a soft body pressed by rigid shapes.
//!
//! The solver is quasi-static. Its tetrahedra have a linear pressure, and displacements of twice the resolution, so that nearly incompressible
//! gels do not lock and their pressure is accurate. Lengths are in mm, forces in N, stresses in kPa at the interface and in MPa = N/mm² inside.
//!
//! A [`SoftBody`] is built once from a mesh, a [`Material`] and [`SolverSettings`], and shared by many presses. Each press has a [`State`], which
//! [`SoftBody::advance`] takes from pose to pose of the indenter; every step returns a [`Frame`].

#![allow(clippy::needless_range_loop)] // matrices are written with indices

mod advance;
mod body;
mod build;
mod clock;
mod contact;
mod derivatives;
mod element;
mod error;
mod frame;
mod linear;
mod load;
mod newton;
mod nodal;
mod parallel;
mod push;
mod relaxation;
mod results;
mod sensitivity;
mod settings;
mod state;

pub use body::SoftBody;
pub use derivatives::DerivativeErrors;
pub use element::Element;
pub use error::{Blocker, SoftBodyError, SolveError};
pub use frame::{Cost, Frame};
pub use push::Push;
pub use sensitivity::Direction;
pub use settings::{LinearSolver, SolverSettings};
pub use state::State;
pub use twintac_material::{Material, Model, PronyTerm};

use twintac_material::wide;

/// Megapascals, the unit of stress inside this crate, in a kilopascal.
pub(crate) const MPA_PER_KPA: f64 = 1e-3;
