//! Random presses of a sensor's gel, for the fast twin to learn from.
//!
//! The pressure is read at places all over the floor, not only at the ports: what a shape does there depends on where it presses *relative* to
//! the place, so each press teaches as much as a hundred with eight ports alone.

mod boulder;
mod draw;
mod press;
mod strange;

pub use boulder::exam_surfaces;
pub use press::{TeachError, Teacher};
pub use strange::Strange;
