//! Estimates of the sensor variation of a kind of sensor, from one sensor: the widths of the
//! distributions of `SensorVariation` in `twintac-sensors`.
//!
//! Inputs are a trained model and a characterization of recordings. The output is the text of a
//! TOML file with one line for each field, each with a comment that says from which data, with
//! which provenance (`real`, `emulated` or `simulated`) and from how many values it was estimated.
//!
//! - [`of_model::lines`]: the fields that a trained model gives: differences between taxels, and
//!   the installation of the sensor.
//! - [`of_readings::lines`]: the fields that a characterization of recordings gives: noise,
//!   resolution, zeros, drift, hysteresis, faults, frame rate.
//! - [`text()`]: the file.
//!
//! A field that neither source determines is left out, with the reason; no value is guessed.
//!
//! # How it works
//!
//! `width` has the estimators, `motion` the common motion of the ports, `text` writes the file,
//! which `SensorVariation` reads back.
//!
//! A spread over taxels is a spread about their mean, because one sensor does not tell what its
//! taxels have in common. Known errors of the values (the uncertainty of a contact height, the
//! rounding to a resolution) are subtracted in squares.
//!
//! Of the shifts of the ports, only the rigid motion that they have in common (`motion`) belongs to
//! the installation. It is used if it is larger than twice its standard error.
//!
//! The viscoelastic relaxation of the model is not hysteresis: it depends on time, and a twin in a
//! `SensorBatch` already has it. Hysteresis is a play operator of half width h. Its largest gap
//! between loading and unloading is 2h / (1 + h) of full scale, from which a measured gap gives the
//! width.
//!
//! The crate does not depend on solvers or on the emulated bench.

mod motion;
pub mod of_model;
pub mod of_readings;
mod text;
mod width;

pub use text::{Given, Line, text};
