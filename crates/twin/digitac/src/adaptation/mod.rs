//! A twin of one sensor, adapted to another from a few presses: which presses tell the most, and what they tell.

mod adapt;
mod choose;
mod new_sensor;

pub use adapt::{Adaptation, Adapted, adapt};
pub use choose::choose_presses;
pub use new_sensor::NewSensor;
