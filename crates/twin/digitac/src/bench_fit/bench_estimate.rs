//! What is unknown about a bench: the tip's radius, the height at which it touches, and the true stiffness
//! of the gel.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Estimate, SmoothFactor};
use crate::features::Gains;

/// Values of a bench that no data sheet gives, fitted to training presses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BenchEstimate {
    /// Radius of the spherical tip, mm; `None` if the described indenter was taken as it is.
    pub tip_radius_mm: Option<Estimate>,
    /// By how much the tip is deeper than its recorded height says, mm, by file.
    pub contact_offset_mm: BTreeMap<String, Estimate>,
    /// The same for files that were not fitted: the median of the fitted ones, mm.
    pub contact_offset_elsewhere_mm: f64,
    /// The gel's stiffness over the simulated gel's; `None` without presses of prescribed force, where it
    /// cannot be told from the gains, and where the tip was fitted.
    pub stiffness: Option<Estimate>,
    /// Where ports are and how wide, against the description; `[n_taxels]`, or empty if they were taken as described.
    #[serde(default)]
    pub ports: Vec<PortEstimate>,
    /// What tip and gel do otherwise than simulated; `None` if they were taken as they are.
    #[serde(default)]
    pub smooth_factor: Option<SmoothFactor>,
    /// Whether the gel remembers the presses before.
    #[serde(default)]
    pub has_history: bool,
    /// The gains that went with these values.
    pub gains: Option<Gains>,
    /// Mean absolute deviation of the fit over the largest reading, %.
    pub deviation_percent: f64,
    /// Warnings about the fit, in words.
    pub doubts: Vec<String>,
}

impl BenchEstimate {
    /// A bench that is exactly as described.
    #[must_use]
    pub(crate) fn nominal() -> Self {
        Self {
            tip_radius_mm: None,
            contact_offset_mm: BTreeMap::new(),
            contact_offset_elsewhere_mm: 0.0,
            stiffness: None,
            ports: Vec::new(),
            smooth_factor: None,
            has_history: false,
            gains: None,
            deviation_percent: 0.0,
            doubts: Vec::new(),
        }
    }

    /// By how much the tip of a mounting is deeper than its recordings say, mm.
    #[must_use]
    pub fn contact_offset_mm(&self, mounting: &str) -> f64 {
        self.contact_offset_mm
            .get(mounting)
            .map_or(self.contact_offset_elsewhere_mm, |offset| offset.value)
    }

    /// The same for a sensor whose ports are described to be elsewhere in the gel's plane, mm; `[n_taxels]`.
    #[must_use]
    pub fn with_ports_at(mut self, ports_mm: &[[f64; 2]]) -> Self {
        if let Some(factor) = &mut self.smooth_factor {
            factor.ports_mm = ports_mm.to_vec();
        }
        self
    }

    /// The gel's stiffness over the simulated gel's.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stiffness.map_or(1.0, |stiffness| stiffness.value)
    }
}

/// How a port differs from its description.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PortEstimate {
    /// How far it is shifted along x and y, mm.
    pub shift_mm: [f64; 2],
    /// By how much its radius is larger, mm. The same for all ports of a sensor.
    pub wider_mm: f64,
}

impl PortEstimate {
    /// By how much this changes the port's pressure, from how the pressure changes with its place along x, along y and with its radius.
    pub(crate) fn change_kpa(&self, slope_kpa_per_mm: [f64; 3]) -> f64 {
        let [x, y, wider] = slope_kpa_per_mm;
        x * self.shift_mm[0] + y * self.shift_mm[1] + wider * self.wider_mm
    }
}
