//! The stages of a run, a file each. What a stage depends on are the fields of its struct.

pub(crate) mod evaluation;
mod meshing;
pub(crate) mod pairs;
pub(crate) mod recordings;
pub(crate) mod simulation;
pub(crate) mod training;
