//! What the ports and the tip of a bench do to the pressures that are simulated.

use std::collections::BTreeMap;

use super::tip_form::DistanceSplines;
use super::{BenchEstimate, PortEstimate, TipForm};

/// By how much pressures at the ports differ from those that are simulated, while the tip is at one place.
#[derive(Clone, Debug)]
pub struct PortCorrection {
    /// `[n_taxels]`, or empty if ports were taken as described.
    ports: Vec<PortEstimate>,
    /// The form of the tip, with the splines of each port's distance.
    form: Option<(TipForm, Vec<DistanceSplines>)>,
}

impl BenchEstimate {
    /// The correction of port pressures while the tip is at a place of the gel's plane, mm.
    #[must_use]
    pub fn correction_at(&self, place_mm: [f64; 2]) -> PortCorrection {
        let with_splines = |form: &TipForm| {
            let taxels = 0..form.ports_mm.len();
            let splines = taxels.map(|taxel| form.splines(taxel, place_mm)).collect();
            (form.clone(), splines)
        };
        PortCorrection {
            ports: self.ports.clone(),
            form: self.tip_form.as_ref().map(with_splines),
        }
    }

    /// The bench for an indenter that it was not fitted with, and that is as described: without what was found of tips, at the median of the
    /// contact heights. What was found of ports and gel stays.
    #[must_use]
    pub fn with_described_tip(&self) -> Self {
        Self {
            tip_radius_mm: None,
            tip_form: None,
            contact_offset_mm: BTreeMap::new(),
            ..self.clone()
        }
    }
}

impl PortCorrection {
    /// Corrects the simulated pressures of a frame, kPa; `[n_taxels]`. `slopes_kpa_per_mm` is how each changes with its port's place along
    /// x, along y and with its radius.
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
        if let Some((form, splines)) = &self.form {
            for (value, splines) in pressure_kpa.iter_mut().zip(splines) {
                *value *= form.factor(splines, depth_mm);
            }
        }
    }
}
