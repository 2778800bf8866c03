//! A trained twin: from a simulated gel to what the barometers would read.

use crate::network::{Network, Physics, Weights, matrix, numbers};
use crate::{Features, Gains, Normalization, Variant};

/// A trained twin of one sensor.
#[derive(Clone, Debug)]
pub struct Twin {
    taxels: Vec<String>,
    physics: Physics,
    hidden: Vec<usize>,
    weights: Weights,
    network: Network,
    gains: Gains,
}

impl Twin {
    /// Weights travel as plain numbers, so that a twin predicts the same bits before and after it was saved.
    pub(crate) fn with_weights(
        taxels: Vec<String>,
        physics: Physics,
        hidden: Vec<usize>,
        weights: Weights,
    ) -> Result<Self, String> {
        let network = Network::with_weights(&physics, &hidden, &weights)?;
        let gains = network.gains(&physics);
        Ok(Self {
            taxels,
            physics,
            hidden,
            weights,
            network,
            gains,
        })
    }

    /// What the barometers would read above their unloaded baseline along a simulated press, kPa;
    /// `[n_frames][n_taxels]`.
    #[must_use]
    pub fn predict(&self, features: &Features) -> Vec<Vec<f64>> {
        let n_taxels = self.taxels.len();
        if features.n_frames() == 0 {
            return Vec::new();
        }
        let device = crate::network::device();
        let inputs = matrix(
            self.physics.inputs(features),
            [features.n_frames(), n_taxels],
            &device,
        );
        let elastic = numbers(self.network.elastic(&self.physics, inputs.clone(), inputs));
        let reading_kpa = self.physics.normalization.reading_kpa;
        let rows = elastic
            .chunks(n_taxels)
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

    /// The scales of its inputs and outputs.
    #[must_use]
    pub fn normalization(&self) -> &Normalization {
        &self.physics.normalization
    }

    pub(crate) fn physics(&self) -> &Physics {
        &self.physics
    }

    pub(crate) fn hidden(&self) -> &[usize] {
        &self.hidden
    }

    pub(crate) fn weights(&self) -> &Weights {
        &self.weights
    }
}
