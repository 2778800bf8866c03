//! Measured and simulated frames side by side, on one clock.

mod pairing;
mod time_warp;

pub use pairing::{PairSettings, PairedPress, pair};
pub use time_warp::{Warp, WarpSettings};
