//! The networks: one reads a place of the floor from what touches around it, others the force, or all taxels, from what touches anywhere.

mod local;
mod patch;
mod perceptron;
mod silu;

pub(crate) use local::LocalNetwork;
pub(crate) use patch::{Patch, Surroundings, Turn};
pub(crate) use perceptron::Perceptron;
pub(crate) use silu::silu;
