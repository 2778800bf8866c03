//! How far sensors of a kind are from perfect: the widths of [`Imperfection`](twintac_sensors::Imperfection), estimated from one of them.
//!
//! A trained model tells how its taxels and mountings differ ([`of_model`]), a characterization what the read-out does ([`of_readings`]); [`text`] writes
//! the file. What neither tells is left out, with the reason: nothing is guessed. Every width says where it comes from and on how many values it rests.

mod motion;
pub mod of_model;
pub mod of_readings;
mod text;
mod width;

pub use text::{Given, Line, text};
