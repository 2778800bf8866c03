//! Finite-strain FEM of a soft body pressed by rigid shapes.
//!
//! Quasi-static, on linear tetrahedra with a linear pressure field of its own, so that nearly incompressible gels neither lock nor
//! report a meaningless pressure. Lengths in mm, forces in N, stresses in kPa at the interface and in MPa = N/mm² inside.

mod advance;
mod body;
mod contact;
mod element;
mod error;
mod krylov;
mod material;
mod newton;
mod ordering;
mod pressure;
mod settings;
mod state;
mod system;

pub use body::SoftBody;
pub use error::{SoftBodyError, SolveError};
pub use material::{Isochoric, Material, PronyTerm};
pub use settings::SolverSettings;
pub use state::{Frame, State};
