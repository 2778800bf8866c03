//! WebAssembly has no factors of the whole system: they are for comparison only, and would be a
//! third of the code that a page loads.

use std::convert::Infallible;

use super::block::Vector;
use super::matrix::{Matrix, Pattern};
use crate::SoftBodyError;

/// The system of `direct`, which does not exist here.
pub(crate) struct DirectSystem(Infallible);

impl DirectSystem {
    pub(crate) fn new(pattern: &Pattern) -> Result<Self, SoftBodyError> {
        Err(SoftBodyError::Analysis {
            n_unknowns: 3 * pattern.halves.free + pattern.n_coarse(),
            reason: "WebAssembly has only the two-level solver".to_owned(),
        })
    }

    pub(crate) fn solve(&self, _: &Matrix, _: &[Vector], _: &mut [Vector], _: &mut [f32]) -> bool {
        match self.0 {}
    }
}
