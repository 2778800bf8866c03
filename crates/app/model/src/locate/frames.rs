//! Estimated contacts, frame by frame, beside the true ones of the recording.

use serde::Serialize;

/// Estimated contacts during a press.
#[derive(Clone, Debug, Serialize)]
pub struct LocatedPress {
    /// The press's name.
    pub name: String,
    /// Name of the mounting (one installation of sensor and indenter).
    pub mounting: String,
    /// Whether the twin was trained on this press.
    pub trained_on: bool,
    /// Its frames.
    pub frames: Vec<LocatedFrame>,
}

/// The estimated contact in a frame. Fields `true_…` come from the recording's poses, which the
/// estimator does not use.
#[derive(Clone, Debug, Serialize)]
pub struct LocatedFrame {
    /// Time, s, on the recording's clock.
    pub time_s: f64,
    /// Name of the indenter; `None` if no contact was found.
    pub indenter: Option<String>,
    /// Location along x and y, mm.
    pub place_mm: Option<[f64; 2]>,
    /// Standard deviation of the location along x and y, mm.
    pub place_deviation_mm: Option<[f64; 2]>,
    /// Depth below first contact, mm.
    pub depth_mm: Option<f64>,
    /// Standard deviation of the depth, mm.
    pub depth_deviation_mm: Option<f64>,
    /// Force into the gel, N: that of the simulated gel times the fitted stiffness, with the error
    /// of that stiffness.
    pub force_n: Option<f64>,
    /// Residual of the readings that the press does not explain, in standard deviations.
    pub misfit: Option<f64>,
    /// True location of the indenter along x and y, mm.
    pub true_place_mm: [f64; 2],
    /// True depth below first contact, with the contact height of the mounting, mm; negative above
    /// the gel. `None` if the pose's height was not recorded.
    pub true_depth_mm: Option<f64>,
    /// Largest reading, kPa above the zero, without its viscoelastic part.
    pub largest_kpa: f64,
}
