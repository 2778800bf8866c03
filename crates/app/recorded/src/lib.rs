//! Recordings and logs of a test setup, in use: characterization of a sensor, and export of frames
//! to other formats.
//!
//! - [`Recorded`] reads Parquet recordings, MCAP logs and, through an import description, tables of
//!   other laboratories. [`Recorded::characterize`] computes what the sensor does (noise, drift,
//!   sensitivity, hysteresis and more); [`Recorded::write`] writes the report and the data sheet.
//! - [`export`] writes the frames of a log as a Parquet table, [`export_ros`] writes a log as a ROS
//!   2 bag of standard messages, and [`export_lerobot`] writes presses as a LeRobot data set.
//!
//! # How it works
//!
//! Times are in s, readings in kPa, forces in N, temperatures in °C. A [`Recorded`] holds two
//! parts: the presses of all files, and the frames outside of presses, each log on its own clock.
//! Frames outside of presses show noise and how zeros move with temperature. If the logs show the
//! latter, [`Recorded::write`] also writes the coefficients ([`COMPENSATION`]), with which later
//! readings can be compensated.
//!
//! Some data are left out, and a note says so: logs that the recorder set aside (`.try-`), a cut
//! log beside its recovered copy, and the press during which the bench stopped. A log that was cut
//! or damaged is read as far as possible; [`export`] and [`export_ros`] also write a whole copy
//! beside it.
//!
//! The figures are defined in `crates/sensor/characterize`, the formats in
//! `crates/sensor/recording` and `crates/bench/log`. This crate reads no environment variable and
//! no argument, prints nothing, and does not depend on `crates/app/run`.

mod export;
mod recorded;

pub use export::{Exported, ExportedBag, LogFound, export, export_lerobot, export_ros};
pub use recorded::{COMPENSATION, Recorded};
