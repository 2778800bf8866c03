//! The stages of a run, a file each.

pub mod evaluation;
mod pairs;
pub mod recordings;
pub mod simulation;
pub mod training;
