//! Scales of features and readings over the training presses, so that inputs and outputs of the
//! network are of order one.

use serde::{Deserialize, Serialize};

use crate::PairedPress;

/// Scales of features and readings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Normalization {
    /// Largest reading, kPa.
    pub(crate) reading_kpa: f64,
    /// Root mean square of the port pressures under load, kPa; `[n_taxels]`.
    pub(crate) pressure_rms_kpa: Vec<f64>,
    /// Mean of the stress features, kPa/mm; `[n_taxels]`.
    pub(crate) stress_mean_kpa_per_mm: Vec<f64>,
    /// Standard deviation of the stress features, kPa/mm; `[n_taxels]`.
    pub(crate) stress_deviation_kpa_per_mm: Vec<f64>,
}

impl Normalization {
    /// The scales of training presses. `None` if there is no usable positive reading.
    pub(crate) fn of(presses: &[&PairedPress]) -> Option<Self> {
        let n_taxels = presses.first()?.readings_kpa.first()?.len();
        let usable = presses
            .iter()
            .flat_map(|p| p.readings_kpa.iter().flatten().zip(p.valid.iter().flatten()));
        let reading_kpa = usable
            .filter(|(_, valid)| **valid)
            .map(|(r, _)| *r)
            .fold(0.0, f64::max);
        let mut normalization = Self {
            reading_kpa,
            pressure_rms_kpa: Vec::new(),
            stress_mean_kpa_per_mm: Vec::new(),
            stress_deviation_kpa_per_mm: Vec::new(),
        };
        for taxel in 0..n_taxels {
            let loaded = presses
                .iter()
                .flat_map(|p| p.features.pressure_kpa.iter().zip(&p.features.depth_mm));
            let pressures: Vec<f64> = loaded
                .filter(|(_, depth)| **depth > 0.0)
                .map(|(row, _)| row[taxel])
                .collect();
            normalization
                .pressure_rms_kpa
                .push(deviation_about(&pressures, 0.0));
            let stresses: Vec<f64> = presses
                .iter()
                .flat_map(|p| p.features.stress_kpa_per_mm.iter().map(|row| row[taxel]))
                .collect();
            let mean = stresses.iter().sum::<f64>() / stresses.len().max(1) as f64;
            normalization.stress_mean_kpa_per_mm.push(mean);
            normalization
                .stress_deviation_kpa_per_mm
                .push(deviation_about(&stresses, mean));
        }
        (reading_kpa > 0.0).then_some(normalization)
    }
}

/// Root mean square distance from a center; 1 if it is zero or there are no values.
fn deviation_about(values: &[f64], center: f64) -> f64 {
    let squares: f64 = values.iter().map(|v| (v - center).powi(2)).sum();
    let deviation = (squares / values.len().max(1) as f64).sqrt();
    if deviation > 0.0 { deviation } else { 1.0 }
}
