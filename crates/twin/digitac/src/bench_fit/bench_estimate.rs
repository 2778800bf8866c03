//! The unknowns of a test setup: the radius of the tip, the height at which it touches, and the
//! true stiffness of the gel.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Estimate, SmoothFactor};
use crate::features::Gains;

/// Estimate of a test setup: values that no data sheet gives, fitted to training presses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BenchEstimate {
    /// Radius of the spherical tip, mm; `None` if the described indenter was used unchanged.
    pub tip_radius_mm: Option<Estimate>,
    /// True minus recorded depth of the tip, mm, by file.
    pub contact_offset_mm: BTreeMap<String, Estimate>,
    /// The same for files that were not fitted, mm: the median of the fitted ones.
    pub contact_offset_elsewhere_mm: f64,
    /// Ratio of the gel's stiffness to that of the simulated gel. `None` without presses of
    /// prescribed force, because the stiffness then cannot be separated from the gains, and where
    /// the tip was fitted.
    pub stiffness: Option<Estimate>,
    /// Differences of the ports from their description; `[n_taxels]`, or empty if the described
    /// ports were used.
    #[serde(default)]
    pub ports: Vec<PortEstimate>,
    /// Correction factor for differences between the real and the simulated tip and gel; `None` if
    /// it was not fitted.
    #[serde(default)]
    pub smooth_factor: Option<SmoothFactor>,
    /// Whether relaxation goes on from press to press.
    #[serde(default)]
    pub has_history: bool,
    /// The gains that were fitted together with these values.
    pub gains: Option<Gains>,
    /// Mean absolute deviation of the fit over the largest reading, %.
    pub deviation_percent: f64,
    /// Warnings of the fit, in words.
    pub doubts: Vec<String>,
}

impl BenchEstimate {
    /// A test setup that is exactly as described.
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

    /// True minus recorded depth of the tip for an installation, mm.
    #[must_use]
    pub fn contact_offset_mm(&self, mounting: &str) -> f64 {
        self.contact_offset_mm
            .get(mounting)
            .map_or(self.contact_offset_elsewhere_mm, |offset| offset.value)
    }

    /// The same for a sensor whose ports are described at other locations of the gel's plane, mm;
    /// `[n_taxels]`.
    #[must_use]
    pub fn with_ports_at(mut self, ports_mm: &[[f64; 2]]) -> Self {
        if let Some(factor) = &mut self.smooth_factor {
            factor.ports_mm = ports_mm.to_vec();
        }
        self
    }

    /// Ratio of the gel's stiffness to that of the simulated gel.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stiffness.map_or(1.0, |stiffness| stiffness.value)
    }
}

/// Difference of a port from its description.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PortEstimate {
    /// Shift along x and y, mm.
    pub shift_mm: [f64; 2],
    /// True minus described radius, mm. It is the same for all ports of a sensor.
    pub wider_mm: f64,
}

impl PortEstimate {
    /// Change of the port's pressure, kPa, from the pressure's derivatives with respect to the
    /// port's x, y and radius.
    pub(crate) fn change_kpa(&self, slope_kpa_per_mm: [f64; 3]) -> f64 {
        let [x, y, wider] = slope_kpa_per_mm;
        x * self.shift_mm[0] + y * self.shift_mm[1] + wider * self.wider_mm
    }
}
