//! What the twin is told of a press: the simulated gel along it, and what each barometer makes of that by itself.

mod gains;
mod overstress;
mod press_features;

pub use gains::Gains;
pub(crate) use gains::{Sample, TIME_CONSTANTS_S};
pub(crate) use overstress::matrix as overstress_matrix;
pub use press_features::Features;
