//! The sensor: a bus with a TCA9548A and eight CPS135B behind it, register by register and clock by clock.
//!
//! Sources: Texas Instruments SCPS207 for the switch; for the barometer, whose data sheet is not public, the registers that CFSensor's
//! XGZP6847D and XGZP6897D (data sheet V2.5) and NOVOSENSE's NSA2300 share. What none of them says is guessed, and stands in
//! [`BarometerSettings`] where it can be.

mod barometer;
mod board;
mod lines;
mod parts;
mod settings;
mod switch;
mod transaction;

pub use board::{Board, Bus};
pub use lines::{ClockLine, DataLine, ResetLine};
pub use settings::{BarometerSettings, BoardSettings};
