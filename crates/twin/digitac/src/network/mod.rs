//! The learned part of a twin: its variants, their parameters, their elastic readings, and
//! gradients with respect to the parameters.
//!
//! The network is small and its structure is fixed, so its gradients are written by hand, and a
//! test compares every derivative with a difference quotient. A framework for automatic
//! differentiation would take a third of the processor time of the whole build.

mod elastic;
mod normalization;
mod parameters;
mod perceptron;
mod physics;
mod twin;
mod variant;

pub(crate) use elastic::{ElasticRows, Pass};
pub(crate) use normalization::Normalization;
pub(crate) use parameters::{Parameters, Weights};
pub(crate) use physics::Physics;
pub use twin::Twin;
pub use variant::Variant;
