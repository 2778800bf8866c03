//! What touches, frame by frame, beside what the recording says.

use serde::Serialize;

/// What touches during a press.
#[derive(Clone, Debug, Serialize)]
pub struct LocatedPress {
    /// The press's name.
    pub name: String,
    /// How gel and indenter were mounted.
    pub mounting: String,
    /// Whether the twin was trained with it.
    pub taught: bool,
    /// Its frames.
    pub frames: Vec<LocatedFrame>,
}

/// What touches in a frame. A truth is what the recording says; nothing was told of it.
#[derive(Clone, Debug, Serialize)]
pub struct LocatedFrame {
    /// Time, s, on the recording's clock.
    pub time_s: f64,
    /// Name of the indenter; `None` if nothing is felt.
    pub indenter: Option<String>,
    /// Place along x and y, mm.
    pub place_mm: Option<[f64; 2]>,
    /// Deviation of the place along x and y, mm.
    pub place_deviation_mm: Option<[f64; 2]>,
    /// Depth below first touch, mm.
    pub depth_mm: Option<f64>,
    /// Deviation of the depth, mm.
    pub depth_deviation_mm: Option<f64>,
    /// Force into the gel, N: the simulated gel's, times the stiffness that was found, and as good as that is known.
    pub force_n: Option<f64>,
    /// What the press leaves of the readings, in deviations.
    pub misfit: Option<f64>,
    /// Place of the indenter along x and y, mm.
    pub true_place_mm: [f64; 2],
    /// Depth below first touch with the contact height of the mounting, mm, negative above the gel; `None` if the pose's height was not recorded.
    pub true_depth_mm: Option<f64>,
    /// Largest reading, kPa above the zero, the memory taken off.
    pub largest_kpa: f64,
}
