//! What a gel is made of.

use serde::{Deserialize, Serialize};

/// A nearly incompressible rubber, at once elastic and slowly relaxing.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Energy of a change of shape; its constants are instantaneous, before anything relaxes.
    pub model: Model,
    /// Resistance to a change of volume, kPa.
    pub bulk_modulus_kpa: f64,
    /// What relaxes; empty for a gel without memory.
    pub prony: Vec<PronyTerm>,
    /// Where the constants come from.
    pub source: String,
}

/// Energy of a change of shape, in the isochoric invariants `Ī1` and `Ī2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Model {
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

/// One way in which the gel relaxes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PronyTerm {
    /// Share of the instantaneous isochoric stiffness that is lost in time; all shares together are below 1.
    pub weight: f64,
    /// Time constant, s.
    pub time_s: f64,
}

impl Model {
    /// Shear modulus at small strain, kPa.
    #[must_use]
    pub fn shear_modulus_kpa(&self) -> f64 {
        match *self {
            Self::NeoHookean { shear_modulus_kpa } => shear_modulus_kpa,
            Self::MooneyRivlin { c10_kpa, c01_kpa } => 2.0 * (c10_kpa + c01_kpa),
            Self::Yeoh { c10_kpa, .. } => 2.0 * c10_kpa,
        }
    }

    /// The name by which descriptions call it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::NeoHookean { .. } => "neo-hookean",
            Self::MooneyRivlin { .. } => "mooney-rivlin",
            Self::Yeoh { .. } => "yeoh",
        }
    }
}

impl Material {
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

    /// Share of the isochoric stiffness that is left after a long time.
    #[must_use]
    pub fn relaxed_share(&self) -> f64 {
        1.0 - self.prony.iter().map(|term| term.weight).sum::<f64>()
    }
}
