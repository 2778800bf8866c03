//! Which gel a surrogate was trained on, and whether it is that of a sensor.

mod gel;
mod mismatch;
mod port;
mod same;

pub(crate) use gel::TrainedOn;
pub use mismatch::FastGelMismatch;
pub(crate) use port::Port;
