//! The invariants of a deformation.

use crate::wide::{Real, Wide};

/// The invariants of eight deformations: with `C = FᵀF`, `I1 = tr C`, `I2 = (I1² - tr C²)/2` and
/// `J = det F`.
#[derive(Clone, Copy, Debug)]
pub struct Invariants<T> {
    /// `I1`
    pub first: Wide<T>,
    /// `I2`; zero for laws that do not use it.
    pub second: Wide<T>,
    /// `J`
    pub volume_ratio: Wide<T>,
    /// `J^(-2/3)`
    pub isochoric: Wide<T>,
}

/// First derivatives of an energy in the invariants.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<T> {
    /// In `I1`.
    pub first: Wide<T>,
    /// In `I2`; read only if the law uses it.
    pub second: Wide<T>,
    /// In `J`.
    pub volume: Wide<T>,
}

/// Second derivatives of an energy in the invariants. Those in `I2` are read only if the law uses
/// `I2`; those in `I1` and `I2` alone are read only if [`Law::IS_CURVED`](crate::Law::IS_CURVED).
#[derive(Clone, Copy, Debug)]
pub struct Curvatures<T> {
    /// Twice in `I1`.
    pub first_first: Wide<T>,
    /// In `I1` and `I2`.
    pub first_second: Wide<T>,
    /// Twice in `I2`.
    pub second_second: Wide<T>,
    /// In `I1` and `J`.
    pub first_volume: Wide<T>,
    /// In `I2` and `J`.
    pub second_volume: Wide<T>,
    /// Twice in `J`.
    pub volume_volume: Wide<T>,
}

impl<T: Real> Slopes<T> {
    /// All zero.
    #[inline(always)]
    #[must_use]
    pub fn none() -> Self {
        let zero = Wide::zero();
        Self {
            first: zero,
            second: zero,
            volume: zero,
        }
    }
}

impl<T: Real> Curvatures<T> {
    /// All zero.
    #[inline(always)]
    #[must_use]
    pub fn none() -> Self {
        let zero = Wide::zero();
        Self {
            first_first: zero,
            first_second: zero,
            second_second: zero,
            first_volume: zero,
            second_volume: zero,
            volume_volume: zero,
        }
    }
}
