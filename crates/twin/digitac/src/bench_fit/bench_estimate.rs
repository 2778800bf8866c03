//! What is unknown about a bench: the tip's radius, the height at which it touches, and the true stiffness
//! of the gel.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::{Estimate, SmoothFactor};
use crate::features::{Gains, TIME_CONSTANTS_S};

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

/// How a bench is fitted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BenchSettings {
    /// Tip radii to simulate, mm, at increasing size; the fit interpolates between them. Empty takes the
    /// described indenter.
    pub tip_radii_mm: Vec<f64>,
    /// How many places, spread over taxels and readings, the fit looks at; more where a file would have too few.
    pub n_places: usize,
    /// Largest correction of the contact height, mm. Zero fits none. What it puts beyond the margin of
    /// [`PlaceSettings`](crate::PlaceSettings) is not simulated: tables go straight on.
    pub contact_offset_limit_mm: f64,
    /// How far a port may be from where it is described, mm. Zero fits no places.
    pub port_shift_limit_mm: f64,
    /// Pull of a port to its place, for each square millimetre. Many presses in a plane, of several shapes, tell places well and need less of it.
    pub port_shift_pull: f64,
    /// By how much the radius of all ports may differ from its description, mm. Zero fits none.
    pub port_radius_limit_mm: f64,
    /// Smallest and largest stiffness over the simulated one. Fitted to presses of prescribed force, if the tip is known: a blunter tip on a
    /// stiffer gel makes the same contact.
    pub stiffness_limits: [f64; 2],
    /// Time constants of the barometers' memory that the fit starts from, s.
    pub time_constants_s: Vec<f64>,
    /// Whether barometers may read otherwise than in proportion to the pressure.
    pub port_law: bool,
    /// Whether the gel remembers the presses before.
    pub history: bool,
    /// Places of the ports in the gel's plane, mm: what tip and gel do otherwise than simulated is fitted as a smooth factor of the distance from them and of
    /// depth. `[n_taxels]`; empty fits none.
    pub ports_mm: Vec<[f64; 2]>,
    /// Pull of that factor to one.
    pub smooth_factor_pull: f64,
    /// Taxels that the fit leaves out, by index.
    pub left_out: BTreeSet<usize>,
    /// How many blocks of places are left out in turn for the uncertainties.
    pub n_blocks: usize,
}

impl Default for BenchSettings {
    fn default() -> Self {
        Self {
            tip_radii_mm: vec![2.0, 3.6, 6.5],
            n_places: 5,
            contact_offset_limit_mm: 0.4,
            port_shift_limit_mm: 0.5,
            port_shift_pull: 1e-3,
            port_radius_limit_mm: 0.5,
            stiffness_limits: [0.5, 2.0],
            time_constants_s: TIME_CONSTANTS_S.to_vec(),
            port_law: true,
            history: true,
            ports_mm: Vec::new(),
            smooth_factor_pull: 1e-5,
            left_out: BTreeSet::new(),
            n_blocks: 6,
        }
    }
}
