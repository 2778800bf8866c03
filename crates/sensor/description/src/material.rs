//! What a gel is made of.

use serde::Serialize;
use twintac_material::{Model, PronyTerm};

/// A nearly incompressible rubber, at once elastic and slowly relaxing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GelMaterial {
    /// Answer to a change of shape; its constants are instantaneous, before anything relaxes.
    pub model: Model,
    /// Resistance to a change of volume, kPa.
    pub bulk_modulus_kpa: f64,
    /// What relaxes; empty for a gel without memory.
    pub prony: Vec<PronyTerm>,
    /// Where the constants come from.
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
