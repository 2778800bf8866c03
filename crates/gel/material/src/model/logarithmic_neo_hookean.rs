//! `W = μ/2 (I1 - 3) - μ ln J`, to which `λ/2 (θ - 1)²` of the averaged volume change is added: the
//! compressible neo-Hookean material whose logarithm resists collapse (Ogden, Non-Linear Elastic
//! Deformations, 1984). The widespread variant with `λ/2 (ln J)²` differs in the third order of the
//! volume change, which in a gel is a few per cent at most.

use serde::{Deserialize, Serialize};

use crate::error::positive;
use crate::stretch_law::NoStretches;
use crate::wide::{Real, Wide};
use crate::{Curvatures, Elastic, Invariants, Law, MaterialError, Slopes};

/// `μ/2 (I1 - 3) - μ ln J`, which also resists a change of volume
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogarithmicNeoHookean {
    /// Shear modulus μ, kPa.
    pub shear_modulus_kpa: f64,
}

impl Elastic for LogarithmicNeoHookean {
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

    /// Lamé's λ.
    fn volume_modulus_kpa(&self, bulk_modulus_kpa: f64) -> f64 {
        bulk_modulus_kpa - 2.0 / 3.0 * self.shear_modulus_kpa
    }
}

impl Law for LogarithmicNeoHookean {
    type Stretches = NoStretches;
    const USES_SECOND: bool = false;
    const IS_CURVED: bool = false;
    const IS_ISOCHORIC: bool = false;
    const BEARS_INVERSION: bool = false;

    #[inline(always)]
    fn energy<T: Real>(&self, at: &Invariants<T>) -> Wide<T> {
        let half_shape = (at.first - Wide::splat(3.0)) * Wide::splat(0.5);
        Wide::splat(self.shear_modulus_kpa) * (half_shape - at.volume_ratio.ln())
    }

    #[inline(always)]
    fn slopes<T: Real>(&self, at: &Invariants<T>) -> Slopes<T> {
        Slopes {
            first: Wide::splat(0.5 * self.shear_modulus_kpa),
            volume: Wide::splat(-self.shear_modulus_kpa) / at.volume_ratio,
            ..Slopes::none()
        }
    }

    #[inline(always)]
    fn curvatures<T: Real>(&self, at: &Invariants<T>) -> Curvatures<T> {
        Curvatures {
            volume_volume: Wide::splat(self.shear_modulus_kpa) / (at.volume_ratio * at.volume_ratio),
            ..Curvatures::none()
        }
    }

    #[inline(always)]
    fn stretches(&self) -> Option<NoStretches> {
        None
    }
}
