//! The clock that time-stamps frames.

/// A clock that never goes back, such as a timer's counter or a monotonic system clock.
///
/// Every `Fn() -> u64` is a clock.
pub trait Clock {
    /// Time since a fixed moment, µs.
    fn now_us(&self) -> u64;
}

impl<F: Fn() -> u64> Clock for F {
    fn now_us(&self) -> u64 {
        self()
    }
}
