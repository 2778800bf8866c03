//! Derivatives of a press by its material: direct differentiation of every equilibrium on the way.
//!
//! At an equilibrium the unbalanced forces `g(u, θ)` are zero for every parameter `θ`, so that
//! `K du/dθ = -∂g/∂θ` with the tangent `K` (Haftka and Gürdal, Elements of Structural Optimization,
//! 1992, chapter 7; for history-dependent materials and contacts: Michaleris, Tortorelli and Vidal,
//! Int. J. Numer. Methods Eng. 37, 1994). `∂g/∂θ` at fixed displacements is a central difference
//! between two materials, whatever their law. The values that one step hands to the next, history
//! variables and multipliers, are differentiated as well. The solver's own tangent, in single
//! precision, is only a preconditioner: residuals are differences of the forces along one
//! direction, in double precision.

mod direction;
mod rates;
mod tangent;

pub use direction::Direction;
pub(crate) use rates::{Sensitivity, follow};
