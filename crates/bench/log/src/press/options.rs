//! How a log is read.

/// How a log's streams become presses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReadOptions {
    /// Longest time without force or pose that is interpolated over, ms. Longer ones are gaps, whether the log says so or not.
    ///
    /// Default 50: more than two of a robot's reports at 100 Hz, and less than a press takes to change much.
    pub longest_interpolated_ms: u64,
    /// How much of the time before a press its taxels' unloaded baseline is the mean of, ms. Default 1000.
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
