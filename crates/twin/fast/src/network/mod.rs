//! The networks: one computes the pressure at a location from the bodies around it; others compute
//! the force, or all taxels, from the whole grid.

mod local;
mod patch;
mod perceptron;
mod silu;

pub(crate) use local::LocalNetwork;
pub(crate) use patch::{Patch, Surroundings, Turn};
pub(crate) use perceptron::Perceptron;
pub(crate) use silu::silu;
