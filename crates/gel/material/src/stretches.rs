//! Laws that depend on the principal stretches alone.

use crate::wide::{Real, Wide};
use crate::{Curvatures, Invariants, Law, Slopes, StretchLaw};

/// A law of the stretches alone, as a [`Law`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretches<L>(pub(crate) L);

impl<L: StretchLaw> Law for Stretches<L> {
    type Stretches = L;
    const USES_SECOND: bool = false;
    const IS_CURVED: bool = false;
    const IS_ISOCHORIC: bool = true;
    const BEARS_INVERSION: bool = false;

    #[inline(always)]
    fn energy<T: Real>(&self, _: &Invariants<T>) -> Wide<T> {
        Wide::zero()
    }

    #[inline(always)]
    fn slopes<T: Real>(&self, _: &Invariants<T>) -> Slopes<T> {
        Slopes::none()
    }

    #[inline(always)]
    fn curvatures<T: Real>(&self, _: &Invariants<T>) -> Curvatures<T> {
        Curvatures::none()
    }

    #[inline(always)]
    fn stretches(&self) -> Option<L> {
        Some(self.0)
    }
}
