//! Result of a recording.

/// Totals of a finished log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recorded {
    /// Messages that were written.
    pub messages: u64,
    /// Messages that were refused because the disk was too slow. The log marks their gaps.
    pub lost: u64,
    /// Size of the log, bytes.
    pub bytes: u64,
}
