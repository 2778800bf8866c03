//! A twin of one sensor, adapted to another from a few presses: selection of the most informative
//! presses, and the adaptation.

mod adapt;
mod choose;
mod new_sensor;

pub use adapt::{Adaptation, Adapted, adapt};
pub use choose::choose_presses;
pub use new_sensor::NewSensor;
