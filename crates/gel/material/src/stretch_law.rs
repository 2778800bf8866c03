//! Energies of the isochoric principal stretches.
//!
//! With `λ̄_i = J^(-1/3) λ_i` the energy is `Σ f(ln λ̄_i)` (the form of Valanis and Landel, J. Appl. Phys. 38, 1967). A stress takes the slopes
//! `f'`, a tangent besides them only quotients `(f'(a) - f'(b))/(a - b)` of the logarithms `a`, `b` of two stretches, which stay well defined
//! where stretches coincide (Simo and Taylor, Comput. Methods Appl. Mech. Eng. 85, 1991).

use crate::wide::{Real, Wide};

/// Derivatives of `f` at three stretches.
#[derive(Clone, Copy, Debug)]
pub struct StretchSlopes<T> {
    /// `f'` at each.
    pub slopes: [Wide<T>; 3],
    /// `f''` at each.
    pub own: [Wide<T>; 3],
    /// `(f'(a) - f'(b))/(a - b)` of the second and the third, the third and the first, the first and the second: of all but the one whose
    /// place it has.
    pub between: [Wide<T>; 3],
}

/// An energy of the change of shape, a sum over the principal stretches.
pub trait StretchLaw: Copy + Sync {
    /// `Σ f`, and `f'` at each, at the logarithms of three isochoric stretches.
    fn energy_and_slopes<T: Real>(&self, logarithms: &[Wide<T>; 3]) -> (Wide<T>, [Wide<T>; 3]);

    /// The derivatives.
    fn derivatives<T: Real>(&self, logarithms: &[Wide<T>; 3]) -> StretchSlopes<T>;
}

/// The part of a law that is a function of the invariants alone: none.
#[derive(Clone, Copy, Debug)]
pub enum NoStretches {}

impl StretchLaw for NoStretches {
    #[inline(always)]
    fn energy_and_slopes<T: Real>(&self, _: &[Wide<T>; 3]) -> (Wide<T>, [Wide<T>; 3]) {
        match *self {}
    }

    #[inline(always)]
    fn derivatives<T: Real>(&self, _: &[Wide<T>; 3]) -> StretchSlopes<T> {
        match *self {}
    }
}
