//! The inputs of the twin: the simulated gel along a press, and the linear reading of each barometer that follows from it.

mod gains;
mod overstress;
mod press_features;

pub use gains::Gains;
pub(crate) use gains::{Sample, TIME_CONSTANTS_S};
pub(crate) use overstress::matrix as overstress_matrix;
pub use press_features::Features;
