//! `W̄ = μ/2 (Ī1 - 3)`: rubber as a network of Gaussian chains (Treloar, 1943). Good to some 50 % of strain.

use super::law::Law;
use crate::wide::{Real, Wide};

#[derive(Clone, Copy)]
pub(crate) struct NeoHookean {
    pub(crate) shear_modulus: f64,
}

impl Law for NeoHookean {
    const USES_SECOND: bool = false;
    const IS_CURVED: bool = false;

    #[inline(always)]
    fn energy<T: Real>(&self, first: Wide<T>, _: Wide<T>) -> Wide<T> {
        Wide::splat(0.5 * self.shear_modulus) * (first - Wide::splat(3.0))
    }

    #[inline(always)]
    fn slopes<T: Real>(&self, _: Wide<T>, _: Wide<T>) -> [Wide<T>; 2] {
        [Wide::splat(0.5 * self.shear_modulus), Wide::zero()]
    }

    #[inline(always)]
    fn curvatures<T: Real>(&self, _: Wide<T>, _: Wide<T>) -> [Wide<T>; 3] {
        [Wide::zero(); 3]
    }
}
