//! The devices of a bench, real or emulated, connected: an [`OpenBench`].

mod lab;
mod open;
mod press;
mod preview;
mod real;

pub use lab::read_faults;
pub use open::OpenBench;
pub use press::{Attended, check_logs};
pub use preview::{Preview, preview};
