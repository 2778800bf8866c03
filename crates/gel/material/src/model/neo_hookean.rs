//! `W̄ = μ/2 (Ī1 - 3)`: rubber as a network of Gaussian chains (Treloar, 1943). Accurate up to a
//! strain of about 50 %.

use serde::{Deserialize, Serialize};

use crate::error::positive;
use crate::isochoric::{Isochoric, IsochoricLaw};
use crate::wide::{Real, Wide};
use crate::{Elastic, MaterialError};

/// `μ/2 (Ī1 - 3)` (Treloar, 1943)
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NeoHookean {
    /// Shear modulus μ, kPa.
    pub shear_modulus_kpa: f64,
}

impl Elastic for NeoHookean {
    type Law<'a> = Isochoric<Self>;

    #[inline(always)]
    fn law(&self) -> Isochoric<Self> {
        Isochoric(*self)
    }

    fn example() -> Self {
        Self {
            shear_modulus_kpa: 23.5,
        }
    }

    fn check(&self) -> Result<(), MaterialError> {
        positive("shear_modulus_kpa", self.shear_modulus_kpa)
    }

    fn shear_modulus_kpa(&self) -> f64 {
        self.shear_modulus_kpa
    }

    fn in_words(&self) -> String {
        String::new()
    }
}

impl IsochoricLaw for NeoHookean {
    const USES_SECOND: bool = false;
    const IS_CURVED: bool = false;

    #[inline(always)]
    fn energy<T: Real>(&self, first: Wide<T>, _: Wide<T>) -> Wide<T> {
        Wide::splat(0.5 * self.shear_modulus_kpa) * (first - Wide::splat(3.0))
    }

    #[inline(always)]
    fn slopes<T: Real>(&self, _: Wide<T>, _: Wide<T>) -> [Wide<T>; 2] {
        [Wide::splat(0.5 * self.shear_modulus_kpa), Wide::zero()]
    }

    #[inline(always)]
    fn curvatures<T: Real>(&self, _: Wide<T>, _: Wide<T>) -> [Wide<T>; 3] {
        [Wide::zero(); 3]
    }
}
