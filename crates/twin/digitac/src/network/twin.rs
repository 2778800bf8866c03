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

    /// What the barometers would read above their unloaded baseline along simulated presses, kPa; `[n_presses][n_frames][n_taxels]`.
    /// The gel remembers presses that follow each other: see [`Features::since_previous_s`].
    #[must_use]
    pub fn predict(&self, presses: &[&Features]) -> Vec<Vec<Vec<f64>>> {
        let reading_kpa = self.physics.normalization.reading_kpa;
        let elastic = |press: &&Features| -> Vec<Vec<f64>> {
            if press.n_frames() == 0 {
                return Vec::new();
            }
            let inputs = self.physics.inputs(press);
            let elastic = self.parameters.elastic(&self.physics, &inputs, &inputs).readings;
            let rows = elastic.rows();
            rows.map(|row| row.iter().map(|r| reading_kpa * f64::from(*r)).collect())
                .collect()
        };
        self.gains
            .remember(presses, presses.iter().map(elastic).collect())
    }

    /// The same twin with other gains; only for variants without a perceptron, which has learned to go with its own.
    #[must_use]
    pub(crate) fn with_gains(&self, gains: Gains) -> Self {
        let physics = Physics {
            gains,
            ..self.physics.clone()
        };
        let parameters = Parameters::new(&physics, &[], 0);
        Self::new(self.taxels.clone(), physics, parameters)
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
