//! Predicted readings of a sensor: frame by frame, and along whole presses, which go through the
//! same steps.

mod at_place;
mod planned;
mod state;
#[cfg(test)]
mod tests;
mod undo;

pub use at_place::TwinAtPlace;
pub use planned::{Prediction, at_place, predict, simulated_recording, unread_press};
pub use state::{TwinMemory, TwinState};
pub use undo::WithoutMemory;
