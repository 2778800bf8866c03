//! Options of reading presses.

/// How the streams of a log become presses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReadOptions {
    /// Longest time without force or pose over which values are interpolated, ms. Longer times are
    /// gaps, also if the log has no mark for them.
    ///
    /// Default 50: longer than two reports of a robot at 100 Hz, and shorter than the time in which
    /// a press changes much.
    pub longest_interpolated_ms: u64,
    /// Time before a press over which its taxels' unloaded baseline is the mean, ms. Default 1000.
    pub baseline_ms: u64,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            longest_interpolated_ms: 50,
            baseline_ms: 1000,
        }
    }
}
