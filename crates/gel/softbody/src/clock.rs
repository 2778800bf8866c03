//! Wall time, for costs and deadlines. WebAssembly has no clock of its own, and that of the
//! standard library panics there. In WebAssembly this clock stands still: costs are zero, and
//! deadlines never come.

#[cfg(not(target_arch = "wasm32"))]
pub(crate) use std::time::Instant;

#[cfg(target_arch = "wasm32")]
pub(crate) use still::Instant;

#[cfg(target_arch = "wasm32")]
mod still {
    use std::ops::{Add, Sub};
    use std::time::Duration;

    /// A moment of a clock that stands still.
    #[derive(Clone, Copy, PartialEq, PartialOrd)]
    pub(crate) struct Instant(Duration);

    impl Instant {
        pub(crate) fn now() -> Self {
            Self(Duration::ZERO)
        }

        pub(crate) fn elapsed(&self) -> Duration {
            Self::now() - *self
        }
    }

    impl Add<Duration> for Instant {
        type Output = Self;

        fn add(self, later: Duration) -> Self {
            Self(self.0 + later)
        }
    }

    impl Sub for Instant {
        type Output = Duration;

        fn sub(self, before: Self) -> Duration {
            self.0.saturating_sub(before.0)
        }
    }
}
