//! Newton's method with a line search down the energy.

mod assembly;
mod direction;
mod evaluation;
mod iteration;
mod line_search;
mod prediction;
mod step;
mod workspace;

pub(crate) use assembly::rest_factors;
pub(crate) use iteration::ALMOST;
pub(crate) use step::{Beginning, Equilibrium, Failure, Start, Step, Unknowns};
pub(crate) use workspace::{Buffers, Workspace};
