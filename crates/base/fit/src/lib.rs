//! Fits within bounds: [`minimize`] is Levenberg and Marquardt's method, [`Triangle`] solves systems of linear equations with a positive definite matrix.
//!
//! Sums have one order, and so the same bits, on every processor.

mod levenberg_marquardt;
mod triangle;

pub use levenberg_marquardt::{Found, Method, Problem, Quadratic, Range, minimize};
pub use triangle::{Triangle, factorize, solve_by};
