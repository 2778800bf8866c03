//! A trained twin: from a simulated gel to the readings of the barometers.

use std::sync::Arc;

use super::{Parameters, Physics, Variant};
use crate::features::Gains;

/// A trained twin of one sensor. Copies share the learned values.
#[derive(Clone, Debug)]
pub struct Twin {
    learned: Arc<Learned>,
}

#[derive(Debug)]
struct Learned {
    taxels: Vec<String>,
    physics: Physics,
    parameters: Parameters,
    gains: Gains,
}

impl Twin {
    pub(crate) fn new(taxels: Vec<String>, physics: Physics, parameters: Parameters) -> Self {
        let gains = parameters.gains(&physics);
        let learned = Learned {
            taxels,
            physics,
            parameters,
            gains,
        };
        Self {
            learned: Arc::new(learned),
        }
    }

    /// The same twin with other gains. Only for variants without a perceptron, which is trained
    /// together with its gains.
    #[must_use]
    pub(crate) fn with_gains(&self, gains: Gains) -> Self {
        let physics = Physics {
            gains,
            ..self.physics().clone()
        };
        let parameters = Parameters::new(&physics, &[], 0);
        Self::new(self.taxels().to_vec(), physics, parameters)
    }

    /// The same twin with gains that were fitted to another sensor, with or without its learned
    /// correction.
    #[must_use]
    pub(crate) fn adapted(&self, gains: Gains, keeps_correction: bool) -> Self {
        let variant = self.variant();
        let physics = Physics {
            variant: if keeps_correction {
                variant
            } else {
                variant.without_perceptron()
            },
            gains,
            ..self.physics().clone()
        };
        let parameters = self.parameters();
        let parameters = Parameters {
            gain_change: vec![0.0; parameters.gain_change.len()],
            memory_change: vec![0.0; parameters.memory_change.len()],
            layers: if keeps_correction {
                parameters.layers.clone()
            } else {
                Vec::new()
            },
        };
        Self::new(self.taxels().to_vec(), physics, parameters)
    }

    /// Names of the taxels, in the order of every row.
    #[must_use]
    pub fn taxels(&self) -> &[String] {
        &self.learned.taxels
    }

    /// The variant of its model.
    #[must_use]
    pub fn variant(&self) -> Variant {
        self.learned.physics.variant
    }

    /// Learned gains and relaxation; the paper's variant does not use any.
    #[must_use]
    pub fn gains(&self) -> &Gains {
        &self.learned.gains
    }

    pub(crate) fn physics(&self) -> &Physics {
        &self.learned.physics
    }

    pub(crate) fn parameters(&self) -> &Parameters {
        &self.learned.parameters
    }
}
