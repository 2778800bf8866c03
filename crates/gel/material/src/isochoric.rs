//! Laws that depend on the change of shape alone, in the invariants.

use crate::stretch_law::NoStretches;
use crate::wide::{Real, Wide};
use crate::{Curvatures, Invariants, Law, Slopes};

/// An energy that depends on the change of shape alone: a function of `Ī1 = J^(-2/3) I1` and
/// `Ī2 = J^(-4/3) I2`.
pub(crate) trait IsochoricLaw: Copy + Sync {
    /// Whether it depends on `Ī2`.
    const USES_SECOND: bool;
    /// Whether any of its second derivatives is nonzero.
    const IS_CURVED: bool;

    /// The energy.
    fn energy<T: Real>(&self, first: Wide<T>, second: Wide<T>) -> Wide<T>;

    /// Its derivatives in `Ī1` and `Ī2`.
    fn slopes<T: Real>(&self, first: Wide<T>, second: Wide<T>) -> [Wide<T>; 2];

    /// Its second derivatives: in `Ī1` twice, in both, in `Ī2` twice.
    fn curvatures<T: Real>(&self, first: Wide<T>, second: Wide<T>) -> [Wide<T>; 3];
}

/// An isochoric law as a [`Law`], by the chain rule.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Isochoric<L>(pub(crate) L);

#[inline(always)]
fn isochoric_invariants<T: Real>(at: &Invariants<T>) -> [Wide<T>; 2] {
    [at.isochoric * at.first, at.isochoric * at.isochoric * at.second]
}

impl<L: IsochoricLaw> Law for Isochoric<L> {
    type Stretches = NoStretches;
    const USES_SECOND: bool = L::USES_SECOND;
    const IS_CURVED: bool = L::IS_CURVED;
    const IS_ISOCHORIC: bool = true;
    const BEARS_INVERSION: bool = false;

    #[inline(always)]
    fn energy<T: Real>(&self, at: &Invariants<T>) -> Wide<T> {
        let [first, second] = isochoric_invariants(at);
        self.0.energy(first, second)
    }

    #[inline(always)]
    fn slopes<T: Real>(&self, at: &Invariants<T>) -> Slopes<T> {
        let [first, second] = isochoric_invariants(at);
        let [in_first, in_second] = self.0.slopes(first, second);
        let mut volume = in_first * first * Wide::splat(-2.0 / 3.0);
        if L::USES_SECOND {
            volume += in_second * second * Wide::splat(-4.0 / 3.0);
        }
        Slopes {
            first: in_first * at.isochoric,
            second: if L::USES_SECOND {
                in_second * at.isochoric * at.isochoric
            } else {
                Wide::zero()
            },
            volume: volume / at.volume_ratio,
        }
    }

    #[inline(always)]
    fn curvatures<T: Real>(&self, at: &Invariants<T>) -> Curvatures<T> {
        let [first, second] = isochoric_invariants(at);
        let [in_first, in_second] = self.0.slopes(first, second);
        let inverse = Wide::splat(1.0) / at.volume_ratio;
        // Derivatives of Ī1 and Ī2 in I1, I2 and J.
        let (scale_1, scale_2) = (at.isochoric, at.isochoric * at.isochoric);
        let volume_1 = first * inverse * Wide::splat(-2.0 / 3.0);
        let volume_2 = second * inverse * Wide::splat(-4.0 / 3.0);
        let mut found = Curvatures {
            first_first: Wide::zero(),
            first_second: Wide::zero(),
            second_second: Wide::zero(),
            first_volume: in_first * scale_1 * inverse * Wide::splat(-2.0 / 3.0),
            second_volume: if L::USES_SECOND {
                in_second * scale_2 * inverse * Wide::splat(-4.0 / 3.0)
            } else {
                Wide::zero()
            },
            volume_volume: in_first * first * inverse * inverse * Wide::splat(10.0 / 9.0)
                + in_second * second * inverse * inverse * Wide::splat(28.0 / 9.0),
        };
        if L::IS_CURVED {
            let [both_1, mixed, both_2] = self.0.curvatures(first, second);
            found.first_first += both_1 * scale_1 * scale_1;
            found.first_second += mixed * scale_1 * scale_2;
            found.second_second += both_2 * scale_2 * scale_2;
            found.first_volume += scale_1 * (both_1 * volume_1 + mixed * volume_2);
            found.second_volume += scale_2 * (both_2 * volume_2 + mixed * volume_1);
            found.volume_volume += both_1 * volume_1 * volume_1
                + mixed * volume_1 * volume_2 * Wide::splat(2.0)
                + both_2 * volume_2 * volume_2;
        }
        found
    }

    #[inline(always)]
    fn stretches(&self) -> Option<NoStretches> {
        None
    }
}
