//! `W̄ = Σ Ci0 (Ī1 - 3)^i`, i = 1, 2, 3 (Yeoh, Rubber Chem. Technol. 66, 1993): stiffens at large strain.

use super::law::Law;
use crate::wide::{Real, Wide};

#[derive(Clone, Copy)]
pub(crate) struct Yeoh {
    pub(crate) c10: f64,
    pub(crate) c20: f64,
    pub(crate) c30: f64,
}

impl Law for Yeoh {
    const USES_SECOND: bool = false;
    const IS_CURVED: bool = true;

    #[inline(always)]
    fn energy<T: Real>(&self, first: Wide<T>, _: Wide<T>) -> Wide<T> {
        let x = first - Wide::splat(3.0);
        x * (Wide::splat(self.c10) + x * (Wide::splat(self.c20) + x * Wide::splat(self.c30)))
    }

    #[inline(always)]
    fn slopes<T: Real>(&self, first: Wide<T>, _: Wide<T>) -> [Wide<T>; 2] {
        let x = first - Wide::splat(3.0);
        let slope =
            Wide::splat(self.c10) + x * (Wide::splat(2.0 * self.c20) + x * Wide::splat(3.0 * self.c30));
        [slope, Wide::zero()]
    }

    #[inline(always)]
    fn curvatures<T: Real>(&self, first: Wide<T>, _: Wide<T>) -> [Wide<T>; 3] {
        let x = first - Wide::splat(3.0);
        let curvature = Wide::splat(2.0 * self.c20) + x * Wide::splat(6.0 * self.c30);
        [curvature, Wide::zero(), Wide::zero()]
    }
}
