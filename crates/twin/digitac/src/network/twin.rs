//! A trained twin: from a simulated gel to what the barometers would read.

use std::sync::Arc;

use super::{Parameters, Physics, Variant};
use crate::features::Gains;

/// A trained twin of one sensor. Copies share what was learned.
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

    /// The same twin with other gains; only for variants without a perceptron, which has learned to go with its own.
    #[must_use]
    pub(crate) fn with_gains(&self, gains: Gains) -> Self {
        let physics = Physics {
            gains,
            ..self.physics().clone()
        };
        let parameters = Parameters::new(&physics, &[], 0);
        Self::new(self.taxels().to_vec(), physics, parameters)
    }

    /// The same twin, each of whose taxels reads so many times as much; `[n_taxels]`. The port law goes with the port, not with the reading. No
    /// factor acts on the paper's variant, which has no gains.
    #[must_use]
    pub(crate) fn with_gain_factors(&self, factors: &[f64]) -> Self {
        let (mut physics, mut parameters) = (self.physics().clone(), self.parameters().clone());
        let own = physics
            .gains
            .stiffening_per_kpa
            .iter_mut()
            .zip(&mut parameters.gain_change);
        for ((stiffening, change), factor) in own.zip(factors) {
            *stiffening /= factor;
            *change += factor.ln() as f32;
        }
        Self::new(self.taxels().to_vec(), physics, parameters)
    }

    /// Names of the taxels, in the order of every row.
    #[must_use]
    pub fn taxels(&self) -> &[String] {
        &self.learned.taxels
    }

    /// Which model it is.
    #[must_use]
    pub fn variant(&self) -> Variant {
        self.learned.physics.variant
    }

    /// Gains and memory as learned; the paper's variant uses none.
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
