//! Wall time, for costs and deadlines. WebAssembly by itself has no clock, and the library's own panics there: no time passes, so that costs are zero and no
//! deadline comes.

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
