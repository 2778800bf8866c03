//! Energies in terms of the isochoric principal stretches.
//!
//! With `λ̄_i = J^(-1/3) λ_i` the energy is `Σ f(ln λ̄_i)` (the form of Valanis and Landel, J.
//! Appl. Phys. 38, 1967). A stress needs the derivatives `f'`. A tangent also needs the difference
//! quotients `(f'(a) - f'(b))/(a - b)` of the logarithms `a`, `b` of two stretches, which stay well
//! defined where stretches coincide (Simo and Taylor, Comput. Methods Appl. Mech. Eng. 85, 1991).

use crate::wide::{Real, Wide};

/// Derivatives of `f` at three stretches.
#[derive(Clone, Copy, Debug)]
pub struct StretchSlopes<T> {
    /// `f'` at each stretch.
    pub slopes: [Wide<T>; 3],
    /// `f''` at each stretch.
    pub own: [Wide<T>; 3],
    /// `(f'(a) - f'(b))/(a - b)`; entry `k` is that of the two stretches other than `k`: second and
    /// third, third and first, first and second.
    pub between: [Wide<T>; 3],
}

/// An energy of the change of shape: a sum over the principal stretches.
pub trait StretchLaw: Copy + Sync {
    /// `Σ f`, and `f'` at each stretch, from the logarithms of the three isochoric stretches.
    fn energy_and_slopes<T: Real>(&self, logarithms: &[Wide<T>; 3]) -> (Wide<T>, [Wide<T>; 3]);

    /// The derivatives at the logarithms of the three isochoric stretches.
    fn derivatives<T: Real>(&self, logarithms: &[Wide<T>; 3]) -> StretchSlopes<T>;
}

/// The stretch part of a law that depends on the invariants alone: there is none.
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
