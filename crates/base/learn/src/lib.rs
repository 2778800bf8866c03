//! Building blocks of small neural networks: matrices of single precision, linear layers, and the
//! optimizer AdamW.
//!
//! - [`Matrix`]: values row by row, and products.
//! - [`Linear`]: a linear layer `y = x w + b`, with its forward and backward pass.
//! - [`AdamW`]: updates arrays of parameters from their gradients.
//!
//! Values have no units here: the networks scale their inputs and outputs themselves.
//!
//! # How it works
//!
//! The networks of this project are small and have a fixed structure. Their gradients are written
//! by hand, and tested against difference quotients. The backward pass of a layer gives the
//! gradients of its parameters and of its input; a network chains them.
//!
//! Products add their terms in a fixed order, with fused multiplication and addition, so results
//! have the same bits on every processor. A row of a product has the same bits whatever number of
//! rows the matrix has. Products are compiled for several instruction sets, and the fastest one is
//! chosen at run time.
//!
//! This crate depends on no other crate of the workspace and reads no files.

mod adamw;
mod linear;
mod matrix;

pub use adamw::{AdamW, AdamWSettings};
pub use linear::{Linear, add};
pub use matrix::Matrix;
