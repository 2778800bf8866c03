//! What came of a recording.

/// What became of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recorded {
    /// Messages that were written.
    pub messages: u64,
    /// Messages that were refused because the disk did not keep up; the log has their gaps.
    pub lost: u64,
    /// Size of the log.
    pub bytes: u64,
}
