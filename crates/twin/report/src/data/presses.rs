//! Readings of presses, measured and predicted.

use twintac_map::Rectangle;

/// One press over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PressSeries {
    /// Why it is shown: "best", "median" or "worst".
    pub label: String,
    /// Which press of which recording.
    pub name: String,
    /// Error of the nearest taxel in contact, %.
    pub nearest_in_contact_percent: f64,
    /// Names of the taxels.
    pub taxels: Vec<String>,
    /// Time of each frame, s.
    pub time_s: Vec<f64>,
    /// Measured pressure above the baseline, kPa, `[n_frames][n_taxels]`.
    pub sensor_kpa: Vec<Vec<f64>>,
    /// Predicted pressure above the baseline, kPa, `[n_frames][n_taxels]`.
    pub twin_kpa: Vec<Vec<f64>>,
    /// Depth of the indenter below the first contact, mm, `[n_frames]`; empty if unknown.
    pub depth_mm: Vec<f64>,
    /// Measured axial force, N, `[n_frames]`; empty if unknown.
    pub sensor_force_n: Vec<f64>,
    /// Simulated axial force, N, `[n_frames]`; empty if unknown.
    pub twin_force_n: Vec<f64>,
}

/// One press at its peak.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PressPeak {
    /// Which press of which recording.
    pub name: String,
    /// The gel's surface from above, mm.
    pub gel_mm: Rectangle,
    /// Places of the taxels, mm.
    pub taxels_mm: Vec<[f64; 2]>,
    /// Measured pressure above the baseline, kPa, one a taxel.
    pub sensor_kpa: Vec<f64>,
    /// Predicted pressure above the baseline, kPa, one a taxel.
    pub twin_kpa: Vec<f64>,
    /// Centre (mm) and radius (mm) of the indenter from above.
    pub indenter_mm: Option<([f64; 2], f64)>,
}

/// Errors of static presses over the gel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlaceErrors {
    /// Where each press was, mm.
    pub places_mm: Vec<[f64; 2]>,
    /// Error of the nearest taxel of each press, %.
    pub nearest_percent: Vec<f64>,
    /// Mean error of all taxels of each press, %; empty if unknown.
    pub all_percent: Vec<f64>,
    /// Places of the taxels, mm.
    pub taxels_mm: Vec<[f64; 2]>,
}

/// All readings, measured and predicted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Agreement {
    /// Measured, kPa.
    pub measured_kpa: Vec<f64>,
    /// Predicted, kPa, in the same order.
    pub predicted_kpa: Vec<f64>,
}
