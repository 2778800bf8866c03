//! What the finite elements ask of a material: its energy as a function of the invariants of the deformation, and the derivatives.
//!
//! With `C = FᵀF` the invariants are `I1 = tr C`, `I2 = (I1² - tr C²)/2` and `J = det F`. An energy of the change of shape alone is a
//! function of `Ī1 = J^(-2/3) I1` and `Ī2 = J^(-4/3) I2`; the chain rule takes its derivatives to those in `I1`, `I2` and `J`.

use crate::wide::{Real, Wide};

/// The invariants of eight deformations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Invariants<T> {
    /// `I1`
    pub(crate) first: Wide<T>,
    /// `I2`; zero for laws that do not ask for it.
    pub(crate) second: Wide<T>,
    /// `J`
    pub(crate) volume_ratio: Wide<T>,
    /// `J^(-2/3)`
    pub(crate) isochoric: Wide<T>,
}

/// First derivatives of an energy in the invariants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slopes<T> {
    pub(crate) first: Wide<T>,
    pub(crate) second: Wide<T>,
    pub(crate) volume: Wide<T>,
}

/// Second derivatives of an energy in the invariants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curvatures<T> {
    pub(crate) first_first: Wide<T>,
    pub(crate) first_second: Wide<T>,
    pub(crate) second_second: Wide<T>,
    pub(crate) first_volume: Wide<T>,
    pub(crate) second_volume: Wide<T>,
    pub(crate) volume_volume: Wide<T>,
}

/// An energy of the change of shape, in units of its constants: a function of `Ī1` and `Ī2`.
pub(crate) trait Law: Copy + Sync {
    /// Whether it depends on `Ī2`.
    const USES_SECOND: bool;
    /// Whether any of its second derivatives in `Ī1` and `Ī2` is other than zero.
    const IS_CURVED: bool;

    /// The energy.
    fn energy<T: Real>(&self, first: Wide<T>, second: Wide<T>) -> Wide<T>;

    /// Its derivatives in `Ī1` and `Ī2`.
    fn slopes<T: Real>(&self, first: Wide<T>, second: Wide<T>) -> [Wide<T>; 2];

    /// Its second derivatives: in `Ī1` twice, in both, in `Ī2` twice.
    fn curvatures<T: Real>(&self, first: Wide<T>, second: Wide<T>) -> [Wide<T>; 3];
}

impl<T: Real> Invariants<T> {
    #[inline(always)]
    fn isochoric_first(&self) -> Wide<T> {
        self.isochoric * self.first
    }

    #[inline(always)]
    fn isochoric_second(&self) -> Wide<T> {
        self.isochoric * self.isochoric * self.second
    }

    #[inline(always)]
    pub(crate) fn energy<L: Law>(&self, law: &L) -> Wide<T> {
        law.energy(self.isochoric_first(), self.isochoric_second())
    }

    #[inline(always)]
    pub(crate) fn slopes<L: Law>(&self, law: &L) -> Slopes<T> {
        let (first, second) = (self.isochoric_first(), self.isochoric_second());
        let [in_first, in_second] = law.slopes(first, second);
        let mut volume = in_first * first * Wide::splat(-2.0 / 3.0);
        if L::USES_SECOND {
            volume += in_second * second * Wide::splat(-4.0 / 3.0);
        }
        Slopes {
            first: in_first * self.isochoric,
            second: in_second * self.isochoric * self.isochoric,
            volume: volume / self.volume_ratio,
        }
    }

    #[inline(always)]
    pub(crate) fn curvatures<L: Law>(&self, law: &L) -> Curvatures<T> {
        let (first, second) = (self.isochoric_first(), self.isochoric_second());
        let [in_first, in_second] = law.slopes(first, second);
        let inverse = Wide::splat(1.0) / self.volume_ratio;
        // Derivatives of Ī1 and Ī2 in I1, I2 and J.
        let (scale_1, scale_2) = (self.isochoric, self.isochoric * self.isochoric);
        let volume_1 = first * inverse * Wide::splat(-2.0 / 3.0);
        let volume_2 = second * inverse * Wide::splat(-4.0 / 3.0);
        let mut found = Curvatures {
            first_first: Wide::zero(),
            first_second: Wide::zero(),
            second_second: Wide::zero(),
            first_volume: in_first * scale_1 * inverse * Wide::splat(-2.0 / 3.0),
            second_volume: in_second * scale_2 * inverse * Wide::splat(-4.0 / 3.0),
            volume_volume: in_first * first * inverse * inverse * Wide::splat(10.0 / 9.0)
                + in_second * second * inverse * inverse * Wide::splat(28.0 / 9.0),
        };
        if L::IS_CURVED {
            let [both_1, mixed, both_2] = law.curvatures(first, second);
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
}
