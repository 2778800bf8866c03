//! `W̄ = C10 (Ī1 - 3) + C01 (Ī2 - 3)` (Mooney, 1940; Rivlin, 1948).

use serde::{Deserialize, Serialize};

use crate::error::positive;
use crate::isochoric::{Isochoric, IsochoricLaw};
use crate::wide::{Real, Wide};
use crate::{Elastic, MaterialError};

/// `C10 (Ī1 - 3) + C01 (Ī2 - 3)` (Mooney, 1940; Rivlin, 1948)
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MooneyRivlin {
    /// C10, kPa.
    pub c10_kpa: f64,
    /// C01, kPa; 0 or more.
    pub c01_kpa: f64,
}

impl Elastic for MooneyRivlin {
    type Law<'a> = Isochoric<Self>;

    #[inline(always)]
    fn law(&self) -> Isochoric<Self> {
        Isochoric(*self)
    }

    fn example() -> Self {
        Self {
            c10_kpa: 8.0,
            c01_kpa: 3.5,
        }
    }

    fn check(&self) -> Result<(), MaterialError> {
        positive("c10_kpa", self.c10_kpa)?;
        if self.c01_kpa.is_finite() && self.c01_kpa >= 0.0 {
            Ok(())
        } else {
            Err(MaterialError::value("c01_kpa", self.c01_kpa, "0 or more"))
        }
    }

    fn shear_modulus_kpa(&self) -> f64 {
        2.0 * (self.c10_kpa + self.c01_kpa)
    }

    fn in_words(&self) -> String {
        format!("C10 {} kPa, C01 {} kPa", self.c10_kpa, self.c01_kpa)
    }
}

impl IsochoricLaw for MooneyRivlin {
    const USES_SECOND: bool = true;
    const IS_CURVED: bool = false;

    #[inline(always)]
    fn energy<T: Real>(&self, first: Wide<T>, second: Wide<T>) -> Wide<T> {
        let three = Wide::splat(3.0);
        Wide::splat(self.c10_kpa) * (first - three) + Wide::splat(self.c01_kpa) * (second - three)
    }

    #[inline(always)]
    fn slopes<T: Real>(&self, _: Wide<T>, _: Wide<T>) -> [Wide<T>; 2] {
        [Wide::splat(self.c10_kpa), Wide::splat(self.c01_kpa)]
    }

    #[inline(always)]
    fn curvatures<T: Real>(&self, _: Wide<T>, _: Wide<T>) -> [Wide<T>; 3] {
        [Wide::zero(); 3]
    }
}
