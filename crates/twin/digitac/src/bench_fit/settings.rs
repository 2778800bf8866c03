//! Settings of the setup calibration, and what it needs of the sensor's description.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, Ranges};

use crate::features::{TIME_CONSTANTS_S, check_time_constants};

/// Settings of the setup calibration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BenchSettings {
    /// Tip radii to simulate, mm, in increasing order; the fit interpolates between them. Default:
    /// 2, 3.6 and 6.5 if the radius of the tip is unknown, otherwise none: the indenter is used as
    /// described.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tip_radii_mm: Option<Vec<f64>>,
    /// Number of locations that the fit uses, spread over taxels and readings; more where a file
    /// would have too few.
    pub n_places: usize,
    /// Largest correction of the contact height, mm. With 0, it is not fitted. Depths beyond the
    /// margin of [`PlaceSettings`](crate::PlaceSettings) are not simulated; the fit extrapolates
    /// tables linearly.
    pub contact_offset_limit_mm: f64,
    /// Largest shift of a port from its described location, mm. With 0, locations are not fitted.
    pub port_shift_limit_mm: f64,
    /// Regularization of a port's shift, per square millimetre. Many presses over a plane, with
    /// several shapes, determine the locations well and need less of it.
    pub port_shift_pull: f64,
    /// Largest difference of the radius of all ports from its description, mm. With 0, it is not
    /// fitted.
    pub port_radius_limit_mm: f64,
    /// Smallest and largest ratio of the stiffness to the simulated one. It is fitted to presses of
    /// prescribed force, if the tip is known: a blunter tip on a stiffer gel makes the same
    /// contact.
    pub stiffness_limits: [f64; 2],
    /// Initial time constants of the barometers' viscoelastic relaxation, s.
    pub time_constants_s: Vec<f64>,
    /// Whether the response of a barometer to pressure may be nonlinear.
    pub port_law: bool,
    /// Whether relaxation goes on from press to press.
    pub history: bool,
    /// Whether a correction factor is fitted for differences between the real and the simulated tip
    /// and gel: a smooth function of the distance from the ports and of depth.
    pub smooth_factor: bool,
    /// Regularization of this factor towards 1.
    pub smooth_factor_pull: f64,
    /// Number of blocks of locations that are left out in turn for the standard errors. With 0,
    /// there are none.
    pub n_blocks: usize,
}

impl BenchSettings {
    /// Radii between which the radius of an unknown tip is sought, mm.
    pub const UNKNOWN_TIP_RADII_MM: [f64; 3] = [2.0, 3.6, 6.5];

    /// Radii to simulate, mm; none if the indenter is used as described.
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

/// Ports and excluded taxels from a sensor's description.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Taxels {
    /// Locations of the ports in the gel's plane, mm; `[n_taxels]`. If they are not known, no
    /// correction factor is fitted.
    pub ports_mm: Vec<[f64; 2]>,
    /// Excluded taxels, by index: fits and headline figures do not use their readings.
    pub left_out: BTreeSet<usize>,
}
