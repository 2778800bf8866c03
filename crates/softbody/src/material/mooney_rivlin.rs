//! `W̄ = C10 (Ī1 - 3) + C01 (Ī2 - 3)` (Mooney, 1940; Rivlin, 1948).

use super::law::Law;
use crate::wide::{Real, Wide};

#[derive(Clone, Copy)]
pub(crate) struct MooneyRivlin {
    pub(crate) c10: f64,
    pub(crate) c01: f64,
}

impl Law for MooneyRivlin {
    const USES_SECOND: bool = true;
    const IS_CURVED: bool = false;

    #[inline(always)]
    fn energy<T: Real>(&self, first: Wide<T>, second: Wide<T>) -> Wide<T> {
        let three = Wide::splat(3.0);
        Wide::splat(self.c10) * (first - three) + Wide::splat(self.c01) * (second - three)
    }

    #[inline(always)]
    fn slopes<T: Real>(&self, _: Wide<T>, _: Wide<T>) -> [Wide<T>; 2] {
        [Wide::splat(self.c10), Wide::splat(self.c01)]
    }

    #[inline(always)]
    fn curvatures<T: Real>(&self, _: Wide<T>, _: Wide<T>) -> [Wide<T>; 3] {
        [Wide::zero(); 3]
    }
}
