//! The material of a gel.

use serde::Serialize;
use twintac_material::{Model, PronyTerm};

/// A nearly incompressible rubber: elastic, with viscoelastic relaxation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GelMaterial {
    /// The hyperelastic model. Its constants are instantaneous, before relaxation.
    pub model: Model,
    /// Bulk modulus, kPa.
    pub bulk_modulus_kpa: f64,
    /// Terms of the Prony series of the relaxation; empty for a purely elastic gel.
    pub prony: Vec<PronyTerm>,
    /// Source of the constants.
    pub source: String,
}

impl GelMaterial {
    /// Instantaneous shear modulus at small strain, kPa.
    #[must_use]
    pub fn shear_modulus_kpa(&self) -> f64 {
        self.model.shear_modulus_kpa()
    }

    /// Instantaneous Young's modulus at small strain, kPa: `9 K G / (3 K + G)`.
    #[must_use]
    pub fn youngs_modulus_kpa(&self) -> f64 {
        let (bulk, shear) = (self.bulk_modulus_kpa, self.shear_modulus_kpa());
        9.0 * bulk * shear / (3.0 * bulk + shear)
    }

    /// Poisson's ratio at small strain: `(3 K - 2 G) / (6 K + 2 G)`.
    #[must_use]
    pub fn poissons_ratio(&self) -> f64 {
        let (bulk, shear) = (self.bulk_modulus_kpa, self.shear_modulus_kpa());
        (3.0 * bulk - 2.0 * shear) / (6.0 * bulk + 2.0 * shear)
    }
}
