//! WebAssembly has no factors of the whole system: they are for comparison alone, and would be a third of what a page loads.

use std::convert::Infallible;

use super::block::Vector;
use super::matrix::{Matrix, Pattern};
use crate::SoftBodyError;

/// The system of `direct`, which is not there.
pub(crate) struct DirectSystem(Infallible);

impl DirectSystem {
    pub(crate) fn new(pattern: &Pattern) -> Result<Self, SoftBodyError> {
        Err(SoftBodyError::Analysis {
            n_unknowns: 3 * pattern.halves.free + pattern.n_coarse(),
            reason: "WebAssembly has the two-level solver alone".to_owned(),
        })
    }

    pub(crate) fn solve(&self, _: &Matrix, _: &[Vector], _: &mut [Vector], _: &mut [f32]) -> bool {
        match self.0 {}
    }
}
