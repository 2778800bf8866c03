//! Which gel a fast gel is of, and whether it is that of a sensor.

mod gel;
mod mismatch;
mod port;
mod same;

pub(crate) use gel::TaughtGel;
pub use mismatch::FastGelMismatch;
pub(crate) use port::Port;
