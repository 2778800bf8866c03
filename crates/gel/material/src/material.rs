//! A material: model, bulk modulus and relaxation.

use serde::{Deserialize, Serialize};

use crate::error::positive;
use crate::{MaterialError, Model, NeoHookean};

/// An isotropic, nearly incompressible rubber, which may relax.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Response to a sudden change of shape.
    pub model: Model,
    /// Bulk modulus at small strain, kPa.
    pub bulk_modulus_kpa: f64,
    /// Relaxation of the deviatoric stress; empty for an elastic material.
    #[serde(default)]
    pub prony: Vec<PronyTerm>,
}

/// One term of a Prony series: a fraction of the instantaneous stress that relaxes with a time
/// constant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PronyTerm {
    /// Fraction of the instantaneous deviatoric stress that relaxes, in (0, 1); the sum over all
    /// terms stays below 1.
    pub weight: f64,
    /// Time constant, s.
    pub time_s: f64,
}

impl Material {
    /// A neo-Hookean material from its constants at small strain: Young's modulus, kPa, and
    /// Poisson's ratio below 1/2.
    #[must_use]
    pub fn neo_hookean(youngs_modulus_kpa: f64, poissons_ratio: f64) -> Self {
        Self {
            model: Model::NeoHookean(NeoHookean {
                shear_modulus_kpa: youngs_modulus_kpa / (2.0 * (1.0 + poissons_ratio)),
            }),
            bulk_modulus_kpa: youngs_modulus_kpa / (3.0 * (1.0 - 2.0 * poissons_ratio)),
            prony: Vec::new(),
        }
    }

    /// Modulus κ of the averaged volume change, kPa; see [`Model::volume_modulus_kpa`].
    #[must_use]
    pub fn volume_modulus_kpa(&self) -> f64 {
        self.model.volume_modulus_kpa(self.bulk_modulus_kpa)
    }

    /// Checks that the constants are those of a material.
    ///
    /// # Errors
    /// The first constant that is wrong.
    pub fn check(&self) -> Result<(), MaterialError> {
        self.model.check()?;
        positive("bulk_modulus_kpa", self.bulk_modulus_kpa)?;
        let (bulk_kpa, shear_kpa) = (self.bulk_modulus_kpa, self.model.shear_modulus_kpa());
        if 3.0 * bulk_kpa <= 2.0 * shear_kpa {
            return Err(MaterialError {
                field: "bulk_modulus_kpa".into(),
                problem: format!(
                    "is {bulk_kpa}, which with a shear modulus of {shear_kpa} kPa makes a negative Poisson's ratio"
                ),
                hint: "give more than 2/3 of the shear modulus".into(),
            });
        }
        self.check_relaxation()
    }

    fn check_relaxation(&self) -> Result<(), MaterialError> {
        for (index, term) in self.prony.iter().enumerate() {
            positive(&format!("prony[{index}].weight"), term.weight)?;
            positive(&format!("prony[{index}].time_s"), term.time_s)?;
        }
        let error = |problem: String, hint: &str| MaterialError {
            field: "prony".into(),
            problem,
            hint: hint.into(),
        };
        let fading: f64 = self.prony.iter().map(|term| term.weight).sum();
        if fading >= 1.0 {
            let hint = "keep the sum of the weights below 1";
            return Err(error(format!("relaxes {fading} of the stiffness"), hint));
        }
        if !self.prony.is_empty() && !self.model.properties().is_isochoric {
            let problem = format!(
                "requires a model of the isochoric energy, which `{}` is not",
                self.model.name()
            );
            return Err(error(problem, "remove it, or choose another model"));
        }
        Ok(())
    }
}
