//! A trained twin: from a simulated gel to what the barometers would read.

use super::{Parameters, Physics, Variant};
use crate::Features;
use crate::features::Gains;

/// A trained twin of one sensor.
#[derive(Clone, Debug)]
pub struct Twin {
    taxels: Vec<String>,
    physics: Physics,
    parameters: Parameters,
    gains: Gains,
}

impl Twin {
    pub(crate) fn new(taxels: Vec<String>, physics: Physics, parameters: Parameters) -> Self {
        let gains = parameters.gains(&physics);
        Self {
            taxels,
            physics,
            parameters,
            gains,
        }
    }

    /// What the barometers would read above their unloaded baseline along a simulated press, kPa;
    /// `[n_frames][n_taxels]`.
    #[must_use]
    pub fn predict(&self, features: &Features) -> Vec<Vec<f64>> {
        if features.n_frames() == 0 {
            return Vec::new();
        }
        let inputs = self.physics.inputs(features);
        let elastic = self.parameters.elastic(&self.physics, &inputs, &inputs).readings;
        let reading_kpa = self.physics.normalization.reading_kpa;
        let rows = elastic
            .rows()
            .map(|row| row.iter().map(|r| reading_kpa * f64::from(*r)).collect());
        self.gains.remember(&features.time_s, rows.collect())
    }

    /// Names of the taxels, in the order of every row.
    #[must_use]
    pub fn taxels(&self) -> &[String] {
        &self.taxels
    }

    /// Which model it is.
    #[must_use]
    pub fn variant(&self) -> Variant {
        self.physics.variant
    }

    /// Gains and memory as learned; the paper's variant uses none.
    #[must_use]
    pub fn gains(&self) -> &Gains {
        &self.gains
    }

    pub(crate) fn physics(&self) -> &Physics {
        &self.physics
    }

    pub(crate) fn parameters(&self) -> &Parameters {
        &self.parameters
    }
}
