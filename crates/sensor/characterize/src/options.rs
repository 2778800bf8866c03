//! What counts as above, slow, fast and long.

use serde::Serialize;

/// What counts as above, slow, fast and long. They stand in the results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CharacterizeOptions {
    /// Farthest that an indenter may be from a taxel, in plan, to press it, mm. Default 1.
    pub above_mm: f64,
    /// Shortest loading, from contact to hold, that is slow: clocks that differ by milliseconds do not matter then, s. Default 1.
    pub slow_s: f64,
    /// Longest rise of the force, from 10 to 90 % of its largest, that is as good as a step, s. Default 0.1.
    pub fast_s: f64,
    /// Shortest hold for creep, s. Default 10.
    pub long_s: f64,
    /// How far a response may be from its line where it is called linear, % of the response at the end of the linear range. Default 5.
    pub linear_percent: f64,
    /// How long readings are averaged to detect a step, s. Default 0.5.
    pub window_s: f64,
    /// How many standard deviations make a detection. Default 3.
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
