//! `W̄ = Σ Ci0 (Ī1 - 3)^i`, i = 1, 2, 3 (Yeoh, Rubber Chem. Technol. 66, 1993): stiffens at large
//! strain.

use serde::{Deserialize, Serialize};

use crate::error::{finite, positive};
use crate::isochoric::{Isochoric, IsochoricLaw};
use crate::wide::{Real, Wide};
use crate::{Elastic, MaterialError};

/// `C10 (Ī1 - 3) + C20 (Ī1 - 3)² + C30 (Ī1 - 3)³` (Yeoh, 1993)
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Yeoh {
    /// C10, kPa.
    pub c10_kpa: f64,
    /// C20, kPa.
    pub c20_kpa: f64,
    /// C30, kPa.
    pub c30_kpa: f64,
}

impl Elastic for Yeoh {
    type Law<'a> = Isochoric<Self>;

    #[inline(always)]
    fn law(&self) -> Isochoric<Self> {
        Isochoric(*self)
    }

    fn example() -> Self {
        Self {
            c10_kpa: 7.9,
            c20_kpa: 0.9,
            c30_kpa: 0.12,
        }
    }

    fn check(&self) -> Result<(), MaterialError> {
        positive("c10_kpa", self.c10_kpa)?;
        finite("c20_kpa", self.c20_kpa)?;
        finite("c30_kpa", self.c30_kpa)
    }

    fn shear_modulus_kpa(&self) -> f64 {
        2.0 * self.c10_kpa
    }

    fn in_words(&self) -> String {
        format!(
            "C10 {} kPa, C20 {} kPa, C30 {} kPa",
            self.c10_kpa, self.c20_kpa, self.c30_kpa
        )
    }
}

impl IsochoricLaw for Yeoh {
    const USES_SECOND: bool = false;
    const IS_CURVED: bool = true;

    #[inline(always)]
    fn energy<T: Real>(&self, first: Wide<T>, _: Wide<T>) -> Wide<T> {
        let x = first - Wide::splat(3.0);
        x * (Wide::splat(self.c10_kpa) + x * (Wide::splat(self.c20_kpa) + x * Wide::splat(self.c30_kpa)))
    }

    #[inline(always)]
    fn slopes<T: Real>(&self, first: Wide<T>, _: Wide<T>) -> [Wide<T>; 2] {
        let x = first - Wide::splat(3.0);
        let slope = Wide::splat(self.c10_kpa)
            + x * (Wide::splat(2.0 * self.c20_kpa) + x * Wide::splat(3.0 * self.c30_kpa));
        [slope, Wide::zero()]
    }

    #[inline(always)]
    fn curvatures<T: Real>(&self, first: Wide<T>, _: Wide<T>) -> [Wide<T>; 3] {
        let x = first - Wide::splat(3.0);
        let curvature = Wide::splat(2.0 * self.c20_kpa) + x * Wide::splat(6.0 * self.c30_kpa);
        [curvature, Wide::zero(), Wide::zero()]
    }
}
