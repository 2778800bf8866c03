//! The law of a material: its energy and the derivatives that finite elements need.

use crate::wide::{Real, Wide};
use crate::{Curvatures, Invariants, Slopes, StretchLaw};

/// The energy per undeformed volume, kPa: `W(I1, I2, J)`, and the part of a [`StretchLaw`]. The
/// term of the averaged volume change is not included. In the undeformed state the energy is zero,
/// which is its minimum.
pub trait Law: Copy + Sync {
    /// The type of its part in isochoric principal stretches.
    type Stretches: StretchLaw;
    /// Whether it depends on `I2`.
    const USES_SECOND: bool;
    /// Whether any of its second derivatives in `I1` and `I2` is nonzero.
    const IS_CURVED: bool;
    /// Whether it depends on the change of shape alone, so that its stress has no hydrostatic part.
    const IS_ISOCHORIC: bool;
    /// Whether it is defined and smooth at `J <= 0`.
    const BEARS_INVERSION: bool;

    /// `W`.
    fn energy<T: Real>(&self, at: &Invariants<T>) -> Wide<T>;

    /// Its first derivatives.
    fn slopes<T: Real>(&self, at: &Invariants<T>) -> Slopes<T>;

    /// Its second derivatives.
    fn curvatures<T: Real>(&self, at: &Invariants<T>) -> Curvatures<T>;

    /// Its part in the stretches, if it has one.
    fn stretches(&self) -> Option<Self::Stretches>;
}

/// What a solver needs to know of a law before it evaluates it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LawProperties {
    /// See [`Law::USES_SECOND`].
    pub uses_second: bool,
    /// See [`Law::IS_CURVED`].
    pub is_curved: bool,
    /// See [`Law::IS_ISOCHORIC`].
    pub is_isochoric: bool,
    /// See [`Law::BEARS_INVERSION`].
    pub bears_inversion: bool,
    /// Whether the law has a part in the principal stretches.
    pub uses_stretches: bool,
}

impl LawProperties {
    /// The properties of a law.
    #[must_use]
    pub fn of<L: Law>(law: &L) -> Self {
        Self {
            uses_second: L::USES_SECOND,
            is_curved: L::IS_CURVED,
            is_isochoric: L::IS_ISOCHORIC,
            bears_inversion: L::BEARS_INVERSION,
            uses_stretches: law.stretches().is_some(),
        }
    }
}
