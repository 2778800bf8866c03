//! What small networks are trained with: matrices of single precision, linear layers, and the optimizer AdamW.
//!
//! Networks of this project are small and of a fixed structure. Their gradients are written by hand, and tested against differences.

mod adamw;
mod linear;
mod matrix;

pub use adamw::{AdamW, AdamWSettings};
pub use linear::{Linear, add};
pub use matrix::Matrix;
