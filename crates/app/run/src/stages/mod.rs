//! The stages of a run, one file each. The fields of a stage's struct are its inputs.

pub(crate) mod evaluation;
mod meshing;
pub(crate) mod pairs;
pub(crate) mod recordings;
pub(crate) mod simulation;
pub(crate) mod training;
