//! The time that stamps a frame.

/// A clock that never goes back, such as a timer's counter or a monotonic system clock.
///
/// Any `Fn() -> u64` is one.
pub trait Clock {
    /// Time since a moment that stays the same while the clock runs, µs.
    fn now_us(&self) -> u64;
}

impl<F: Fn() -> u64> Clock for F {
    fn now_us(&self) -> u64 {
        self()
    }
}
