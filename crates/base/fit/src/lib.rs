//! Least-squares fits within bounds, and linear systems with a positive definite matrix.
//!
//! - [`minimize`] minimizes a cost within bounds, by the method of Levenberg (1944) and Marquardt
//!   (1963). Input: a [`Problem`], which evaluates the cost, its gradient and its Gauss-Newton
//!   matrix; the [`Range`] of each unknown; a start; the [`Method`]. Output: the point with the
//!   smallest cost, [`Found`].
//! - [`Triangle`] is the Cholesky factorization of a matrix of double precision, for the solution
//!   and the inverse.
//!
//! The units are those of the problem.
//!
//! # How it works
//!
//! In each step, the damped Gauss-Newton system is solved for the unknowns that are free: an
//! unknown at a bound stays there if the cost falls towards the outside. The step is shortened so
//! that no unknown changes by more than its [`Range::reach`], and is clamped to the bounds. If the
//! cost falls, the step is taken and the damping becomes smaller; otherwise the damping grows. If
//! the cost cannot be evaluated at the trial point, half of the step is tried, as more damping
//! would turn the step, but shorten it only after many trials.
//!
//! A problem whose derivatives are approximate can correct them by the trial points that were
//! rejected: see [`Problem::rejected`].
//!
//! Sums have one fixed order, so results have the same bits on every processor.
//!
//! This is code of our own (200 lines) for these reasons. `faer` has no minimization within bounds,
//! takes longer to compile than everything that fits, and adds in an order that depends on the
//! processor. A caller that corrects derivatives by rejected steps, as the fit of a material does,
//! needs access to these steps.
//!
//! This crate depends on no other crate of the workspace and reads no files.

mod levenberg_marquardt;
mod triangle;

pub use levenberg_marquardt::{Found, Method, Problem, Quadratic, Range, minimize};
pub use triangle::{Triangle, factorize, solve_by};
