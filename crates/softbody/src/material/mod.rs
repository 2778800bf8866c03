//! What the soft body is made of.
//!
//! The energy per reference volume is split into a part that changes the shape and one that changes the volume,
//! `W = W̄(C̄) + K/2 (J - 1)²`, with `J = det F` and `C̄ = J^(-2/3) FᵀF`, so that the hydrostatic pressure is
//! `-tr(σ)/3 = -K (J - 1)` whatever `W̄` is (Holzapfel, Nonlinear Solid Mechanics, 2000, section 6.4).

mod law;
mod mooney_rivlin;
mod neo_hookean;
mod relaxation;
mod yeoh;

use serde::{Deserialize, Serialize};

use crate::SoftBodyError;

pub(crate) use law::{Invariants, Law};
pub(crate) use mooney_rivlin::MooneyRivlin;
pub(crate) use neo_hookean::NeoHookean;
pub(crate) use relaxation::{Memory, Relaxation};
pub(crate) use yeoh::Yeoh;

/// Kilopascals in a newton per square millimetre, the unit of stress inside this crate.
pub(crate) const KPA_PER_MPA: f64 = 1000.0;

/// A nearly incompressible, possibly relaxing, isotropic rubber.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Answer to a sudden change of shape.
    pub isochoric: Isochoric,
    /// Bulk modulus, kPa.
    pub bulk_modulus_kpa: f64,
    /// How the answer to a change of shape fades; empty for an elastic material.
    #[serde(default)]
    pub prony: Vec<PronyTerm>,
}

/// One term of a Prony series: this part of the instantaneous stress fades with this time constant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PronyTerm {
    /// Part of the instantaneous deviatoric stress that fades, in (0, 1); the sum over all terms stays below 1.
    pub weight: f64,
    /// Time constant, s.
    pub time_s: f64,
}

/// Energy of a change of shape, in the invariants `Ī1 = tr C̄` and `Ī2 = (Ī1² - tr C̄²)/2`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Isochoric {
    /// `μ/2 (Ī1 - 3)`
    NeoHookean {
        /// Shear modulus μ, kPa.
        shear_modulus_kpa: f64,
    },
    /// `C10 (Ī1 - 3) + C01 (Ī2 - 3)`
    MooneyRivlin {
        /// C10, kPa.
        c10_kpa: f64,
        /// C01, kPa.
        c01_kpa: f64,
    },
    /// `C10 (Ī1 - 3) + C20 (Ī1 - 3)² + C30 (Ī1 - 3)³`
    Yeoh {
        /// C10, kPa.
        c10_kpa: f64,
        /// C20, kPa.
        c20_kpa: f64,
        /// C30, kPa.
        c30_kpa: f64,
    },
}

impl Isochoric {
    /// Shear modulus at small strain, kPa.
    #[must_use]
    pub fn shear_modulus_kpa(&self) -> f64 {
        match *self {
            Self::NeoHookean { shear_modulus_kpa } => shear_modulus_kpa,
            Self::MooneyRivlin { c10_kpa, c01_kpa } => 2.0 * (c10_kpa + c01_kpa),
            Self::Yeoh { c10_kpa, .. } => 2.0 * c10_kpa,
        }
    }

    fn constants_kpa(&self) -> [f64; 3] {
        match *self {
            Self::NeoHookean { shear_modulus_kpa } => [shear_modulus_kpa, 0.0, 0.0],
            Self::MooneyRivlin { c10_kpa, c01_kpa } => [c10_kpa, c01_kpa, 0.0],
            Self::Yeoh {
                c10_kpa,
                c20_kpa,
                c30_kpa,
            } => [c10_kpa, c20_kpa, c30_kpa],
        }
    }
}

impl Material {
    /// A neo-Hookean material from what it does at small strain: Young's modulus, kPa, and Poisson's ratio below 1/2.
    #[must_use]
    pub fn neo_hookean(youngs_modulus_kpa: f64, poissons_ratio: f64) -> Self {
        Self {
            isochoric: Isochoric::NeoHookean {
                shear_modulus_kpa: youngs_modulus_kpa / (2.0 * (1.0 + poissons_ratio)),
            },
            bulk_modulus_kpa: youngs_modulus_kpa / (3.0 * (1.0 - 2.0 * poissons_ratio)),
            prony: Vec::new(),
        }
    }

    /// Refuses constants that make no material.
    pub(crate) fn check(&self) -> Result<(), SoftBodyError> {
        let refuse = |what: &str, expected: &str, found: f64| {
            Err(SoftBodyError::Material {
                what: what.into(),
                expected: expected.into(),
                found,
            })
        };
        if let Some(found) = self
            .isochoric
            .constants_kpa()
            .into_iter()
            .find(|constant| !constant.is_finite())
        {
            return refuse("constant", "a finite number of kPa", found);
        }
        let shear_modulus_kpa = self.isochoric.shear_modulus_kpa();
        if shear_modulus_kpa <= 0.0 {
            return refuse(
                "shear modulus at small strain",
                "more than 0 kPa",
                shear_modulus_kpa,
            );
        }
        if !(self.bulk_modulus_kpa.is_finite() && self.bulk_modulus_kpa > 0.0) {
            return refuse(
                "bulk modulus",
                "a finite number of kPa above 0",
                self.bulk_modulus_kpa,
            );
        }
        for term in &self.prony {
            if !(term.weight > 0.0 && term.weight < 1.0) {
                return refuse(
                    "weight of a Prony term",
                    "more than 0 and less than 1",
                    term.weight,
                );
            }
            if !(term.time_s.is_finite() && term.time_s > 0.0) {
                return refuse(
                    "time of a Prony term",
                    "a finite number of s above 0",
                    term.time_s,
                );
            }
        }
        let weights: f64 = self.prony.iter().map(|term| term.weight).sum();
        if weights >= 1.0 {
            return refuse("sum of the weights of the Prony terms", "less than 1", weights);
        }
        Ok(())
    }
}
