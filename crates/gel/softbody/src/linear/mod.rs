//! Newton's linear system, which is solved by conjugate gradients with a two-level preconditioner.
//!
//! With the pressures eliminated, the system is `H = A + B D Bᵀ`: `A` in blocks of 3 × 3 between
//! neighbouring nodes, `B` the derivative of the coarse nodes' volumes, `D` their bulk modulus
//! divided by their volume. All of it is in single precision, which is accurate enough for a
//! direction.

pub(crate) mod block;
pub(crate) mod coarse;
pub(crate) mod cycle;
#[cfg(not(target_arch = "wasm32"))]
pub(crate) mod direct;
mod elimination_order;
mod factors;
pub(crate) mod krylov;
pub(crate) mod matrix;
#[cfg(target_arch = "wasm32")]
pub(crate) mod no_direct;
pub(crate) mod numbering;
mod product;
mod sparsity;
mod sweep;

#[cfg(target_arch = "wasm32")]
pub(crate) use no_direct as direct;
