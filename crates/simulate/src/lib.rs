//! A sensor's gel, meshed and pressed by one of its indenters.

mod sweep;

pub use sweep::{Honesty, Sweep, SweepFrame};
