//! The sensor: a bus with switches (TCA9548A) and barometers behind them, register by register and
//! clock by clock.
//!
//! Sources: Texas Instruments SCPS207 for the switch; for each kind of barometer the documents that
//! its file names. What no source states is a guess, and is a setting in [`BarometerSettings`]
//! where possible.

mod barometer_settings;
mod board;
mod chip;
mod lines;
mod parts;
mod settings;
mod switch;
mod transaction;

pub use barometer_settings::BarometerSettings;
pub use board::{Board, Bus};
pub use lines::{ClockLine, DataLine, ResetLine};
pub use settings::{BoardSettings, PartSettings};
