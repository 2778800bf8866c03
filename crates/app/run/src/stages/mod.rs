//! The stages of a run, a file each.

mod evaluation;
mod pairs;
pub(crate) mod recordings;
mod simulation;
pub(crate) mod training;
