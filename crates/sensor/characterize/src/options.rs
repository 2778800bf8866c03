//! Options: which presses count as above a taxel, slow, fast and long.

use serde::Serialize;

/// Which presses count as above a taxel, slow, fast and long, and thresholds of figures. The
/// results contain these options.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CharacterizeOptions {
    /// Largest horizontal distance of an indenter from a taxel that it presses, mm. Default 1.
    pub above_mm: f64,
    /// Shortest loading, from contact to hold, that counts as slow, s: offsets of milliseconds
    /// between clocks do not matter then. Default 1.
    pub slow_s: f64,
    /// Longest rise of the force from 10 to 90 % of its largest value that counts as fast, s.
    /// Default 0.1.
    pub fast_s: f64,
    /// Shortest hold for which creep is computed, s. Default 10.
    pub long_s: f64,
    /// Largest deviation of a response from its line in the linear range, % of the response at the
    /// end of the range. Default 5.
    pub linear_percent: f64,
    /// Averaging time for detecting a step, s. Default 0.5.
    pub window_s: f64,
    /// Number of standard deviations for a detection. Default 3.
    pub sigmas: f64,
}

impl Default for CharacterizeOptions {
    fn default() -> Self {
        Self {
            above_mm: 1.0,
            slow_s: 1.0,
            fast_s: 0.1,
            long_s: 10.0,
            linear_percent: 5.0,
            window_s: 0.5,
            sigmas: 3.0,
        }
    }
}
