//! How a bench is fitted: what people write, and what the sensor's description says.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, Ranges};

use crate::features::{TIME_CONSTANTS_S, check_time_constants};

/// How a bench is fitted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BenchSettings {
    /// Tip radii to simulate, mm, at increasing size; the fit interpolates between them. Default: 2, 3.6 and 6.5 if the tip's radius is unknown, and otherwise none: the
    /// indenter is taken as described.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tip_radii_mm: Option<Vec<f64>>,
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
    /// Whether what tip and gel do otherwise than simulated is fitted, as a smooth factor of the distance from the ports and of depth.
    pub smooth_factor: bool,
    /// Pull of that factor to one.
    pub smooth_factor_pull: f64,
    /// How many blocks of places are left out in turn for the uncertainties. Zero finds none.
    pub n_blocks: usize,
}

impl BenchSettings {
    /// Radii to look for a tip of unknown radius between, mm.
    pub const UNKNOWN_TIP_RADII_MM: [f64; 3] = [2.0, 3.6, 6.5];

    /// Radii to simulate, mm; none if the indenter is taken as described.
    pub(crate) fn radii_mm(&self) -> &[f64] {
        self.tip_radii_mm.as_deref().unwrap_or_default()
    }
}

impl Default for BenchSettings {
    fn default() -> Self {
        Self {
            tip_radii_mm: None,
            n_places: 5,
            contact_offset_limit_mm: 0.4,
            port_shift_limit_mm: 0.5,
            port_shift_pull: 1e-3,
            port_radius_limit_mm: 0.5,
            stiffness_limits: [0.5, 2.0],
            time_constants_s: TIME_CONSTANTS_S.to_vec(),
            port_law: true,
            history: true,
            smooth_factor: true,
            smooth_factor_pull: 1e-5,
            n_blocks: 6,
        }
    }
}

impl Checked for BenchSettings {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            tip_radii_mm,
            n_places,
            contact_offset_limit_mm,
            port_shift_limit_mm,
            port_shift_pull,
            port_radius_limit_mm,
            stiffness_limits,
            time_constants_s,
            port_law: _,
            history: _,
            smooth_factor: _,
            smooth_factor_pull,
            n_blocks,
        } = self;
        if let Some(radii_mm) = tip_radii_mm {
            ranges.numbers("tip_radii_mm", radii_mm, 6, 0.1..=100.0);
            ranges.rising("tip_radii_mm", radii_mm);
        }
        ranges.number("n_places", *n_places, 1.0..=10_000.0);
        ranges.zero_or("contact_offset_limit_mm", *contact_offset_limit_mm, 0.001..=5.0);
        ranges.zero_or("port_shift_limit_mm", *port_shift_limit_mm, 0.001..=5.0);
        ranges.zero_or("port_shift_pull", *port_shift_pull, 1e-12..=1e6);
        ranges.zero_or("port_radius_limit_mm", *port_radius_limit_mm, 0.001..=5.0);
        ranges.numbers("stiffness_limits", stiffness_limits, 2, 0.01..=100.0);
        ranges.rising("stiffness_limits", stiffness_limits);
        check_time_constants(ranges, time_constants_s);
        ranges.zero_or("smooth_factor_pull", *smooth_factor_pull, 1e-12..=1e6);
        ranges.zero_or("n_blocks", *n_blocks, 2.0..=1000.0);
    }
}

/// What a sensor's description says of its taxels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Taxels {
    /// Places of their ports in the gel's plane, mm; `[n_taxels]`. Where they are not known, no smooth factor is fitted.
    pub ports_mm: Vec<[f64; 2]>,
    /// Those whose readings are not to be trusted, by index: fits and headline figures leave them out.
    pub left_out: BTreeSet<usize>,
}
