//! How long to wait for what may never come.

/// How often to ask again whether a conversion has ended: a bound that no broken clock can move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patience {
    /// Time between two questions, µs.
    pub interval_us: u32,
    /// How many such times to wait.
    pub waits: u32,
}
