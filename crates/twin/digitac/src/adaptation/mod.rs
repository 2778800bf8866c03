//! A twin of one sensor, adapted to another from a few presses: which presses tell the most, and what they tell.

mod adapt;
mod choose;

pub use adapt::{Adaptation, Adapted, adapt};
pub use choose::choose_presses;
