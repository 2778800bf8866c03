//! A limit for waiting.

/// How often to poll whether a conversion has ended. The limit counts polls, so that a broken clock
/// cannot extend it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patience {
    /// Time between two polls, µs.
    pub interval_us: u32,
    /// Number of such waits.
    pub waits: u32,
}
