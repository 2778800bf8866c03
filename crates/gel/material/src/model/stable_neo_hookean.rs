//! The stable neo-Hookean energy (Smith, de Goes and Kim, ACM Trans. Graph. 37, 2018, section 3.4):
//! `m/2 (I1 - 3) + l/2 (J - a)² - m/2 ln(I1 + 1)` with `a = 1 + m/l - m/(4 l)`, `m = 4/3 μ` and
//! `l = λ + 5/6 μ`, where λ and μ are Lamé's constants. It is smooth for every deformation,
//! including inverted ones.
//!
//! Since `l/2 (J - a)² = l/2 (J - 1)² - 3/4 m (J - 1) + constant`, its quadratic term in the volume
//! becomes the term of the averaged volume change. The remaining energy is
//! `W = m/2 (I1 - 3) - m/2 ln((I1 + 1)/4) - 3/4 m (J - 1)`.

use serde::{Deserialize, Serialize};

use crate::error::positive;
use crate::stretch_law::NoStretches;
use crate::wide::{Real, Wide};
use crate::{Curvatures, Elastic, Invariants, Law, MaterialError, Slopes};

/// `m/2 (I1 - 3) - m/2 ln((I1 + 1)/4) - 3/4 m (J - 1)` with `m = 4/3 μ`, for inverted tetrahedra as
/// well (Smith, de Goes and Kim, 2018)
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StableNeoHookean {
    /// Shear modulus μ at small strain, kPa.
    pub shear_modulus_kpa: f64,
}

impl StableNeoHookean {
    /// `m`
    #[inline(always)]
    fn modulus_kpa(&self) -> f64 {
        4.0 / 3.0 * self.shear_modulus_kpa
    }
}

impl Elastic for StableNeoHookean {
    type Law<'a> = Self;

    #[inline(always)]
    fn law(&self) -> Self {
        *self
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

    /// `l = λ + 5/6 μ = K + μ/6`
    fn volume_modulus_kpa(&self, bulk_modulus_kpa: f64) -> f64 {
        bulk_modulus_kpa + self.shear_modulus_kpa / 6.0
    }
}

impl Law for StableNeoHookean {
    type Stretches = NoStretches;
    const USES_SECOND: bool = false;
    const IS_CURVED: bool = true;
    const IS_ISOCHORIC: bool = false;
    const BEARS_INVERSION: bool = true;

    #[inline(always)]
    fn energy<T: Real>(&self, at: &Invariants<T>) -> Wide<T> {
        let quarter = (at.first + Wide::splat(1.0)) * Wide::splat(0.25);
        let shape = (at.first - Wide::splat(3.0) - quarter.ln()) * Wide::splat(0.5 * self.modulus_kpa());
        shape.plus_product(
            at.volume_ratio - Wide::splat(1.0),
            Wide::splat(-0.75 * self.modulus_kpa()),
        )
    }

    #[inline(always)]
    fn slopes<T: Real>(&self, at: &Invariants<T>) -> Slopes<T> {
        let half = Wide::splat(0.5 * self.modulus_kpa());
        Slopes {
            first: half - half / (at.first + Wide::splat(1.0)),
            volume: Wide::splat(-0.75 * self.modulus_kpa()),
            ..Slopes::none()
        }
    }

    #[inline(always)]
    fn curvatures<T: Real>(&self, at: &Invariants<T>) -> Curvatures<T> {
        let beyond = at.first + Wide::splat(1.0);
        Curvatures {
            first_first: Wide::splat(0.5 * self.modulus_kpa()) / (beyond * beyond),
            ..Curvatures::none()
        }
    }

    #[inline(always)]
    fn stretches(&self) -> Option<NoStretches> {
        None
    }
}
