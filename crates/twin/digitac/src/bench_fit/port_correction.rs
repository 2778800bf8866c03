//! Corrections of simulated pressures for the ports and the tip of a test setup.

use std::collections::BTreeMap;

use super::smooth_factor::DistanceSplines;
use super::{BenchEstimate, PortEstimate, SmoothFactor};

/// Correction of simulated pressures at the ports while the tip is at one location.
#[derive(Clone, Debug)]
pub struct PortCorrection {
    /// Differences of the ports; `[n_taxels]`, or empty if the described ports are used.
    ports: Vec<PortEstimate>,
    /// The correction factor, with the splines of each port's distance.
    factor: Option<(SmoothFactor, Vec<DistanceSplines>)>,
}

impl BenchEstimate {
    /// The correction of port pressures while the tip is at a location of the gel's plane, mm.
    #[must_use]
    pub fn correction_at(&self, place_mm: [f64; 2]) -> PortCorrection {
        let with_splines = |factor: &SmoothFactor| {
            let taxels = 0..factor.ports_mm.len();
            let splines = taxels.map(|taxel| factor.splines(taxel, place_mm)).collect();
            (factor.clone(), splines)
        };
        PortCorrection {
            ports: self.ports.clone(),
            factor: self.smooth_factor.as_ref().map(with_splines),
        }
    }

    /// The test setup for an indenter that it was not fitted with, and whose description is right:
    /// without the estimates of tips, and with the median of the contact heights. The estimates of
    /// ports and gel stay.
    #[must_use]
    pub fn with_described_tip(&self) -> Self {
        Self {
            tip_radius_mm: None,
            // If the tip was known, the correction factor belongs to the gel.
            smooth_factor: self
                .smooth_factor
                .clone()
                .filter(|_| self.tip_radius_mm.is_none()),
            contact_offset_mm: BTreeMap::new(),
            ..self.clone()
        }
    }
}

impl PortCorrection {
    /// Corrects the simulated pressures of a frame, kPa; `[n_taxels]`. `slopes_kpa_per_mm` are the
    /// derivatives of each with respect to its port's x, y and radius.
    pub fn apply(
        &self,
        depth_mm: f64,
        slopes_kpa_per_mm: impl IntoIterator<Item = [f64; 3]>,
        pressure_kpa: &mut [f64],
    ) {
        let ports = self.ports.iter().zip(slopes_kpa_per_mm);
        for (value, (port, slope)) in pressure_kpa.iter_mut().zip(ports) {
            *value += port.change_kpa(slope);
        }
        if let Some((factor, splines)) = &self.factor {
            for (value, splines) in pressure_kpa.iter_mut().zip(splines) {
                *value *= factor.factor(splines, depth_mm);
            }
        }
    }
}
