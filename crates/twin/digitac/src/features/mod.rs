//! Inputs of the twin: the simulated gel along a press, and the reading of each barometer that
//! follows from it.

mod gains;
mod overstress;
mod port_law;
mod press_features;

pub use gains::Gains;
pub(crate) use gains::{Remembered, Sample, TIME_CONSTANTS_S, along, check_time_constants, is_pressure};
pub(crate) use overstress::{matrix as overstress_matrix, step as overstress_step};
pub(crate) use port_law::{reading as port_reading, slopes as port_slopes};
pub use press_features::Features;
pub(crate) use press_features::zero_frames;
