//! Recordings of presses: their schema, Parquet files, imports of CSV files and bags, and LeRobot
//! data sets.
//!
//! The unit is a [`Press`]: a named indenter, its pose over time, and what was measured or
//! simulated meanwhile. A [`Recording`] has presses of one sensor. [`Frames`] are readings over
//! time without poses. Lengths are in mm, forces in N, pressures in kPa, times in s, temperatures
//! in °C. Every recording has a [`Provenance`]: `real`, `emulated` or `simulated`. A missing
//! reading is NaN in memory and null in files.
//!
//! - [`Recording::write_parquet`] and [`Recording::read_parquet`] store recordings; a
//!   [`RecordingWriter`] writes presses one by one, and a [`FrameTable`] writes frames.
//! - [`Import`] reads CSV files and bags of any test setup. Its description says which column means
//!   what, in which unit. [`guess_import`] writes a first description for a file.
//! - [`Recording::write_lerobot`] writes a data set for LeRobot.
//!
//! # How it works
//!
//! ```text
//! press, frames, check   recordings in memory, and the conditions that all of them meet
//! store/                 Parquet files: one row per frame, and a checksum
//! import/                CSV files: layout, cells, units, clocks, split into presses, zeros
//! import/bag             bags: topics on one clock, as one table
//! import/guess           a first import description for a file
//! import/correlate       the clock of one file on that of another, from presses in both
//! lerobot/               LeRobot data sets, version 3.0
//! ```
//!
//! Parquet: a row group ends with the press that fills it ([`RecordingWriter`]), so the bytes of a
//! file depend only on its presses. Files of recordings have a seal before the footer: the SHA-256
//! of all other bytes, computed while the file is written. It detects any damage, and the file
//! remains a valid Parquet file.
//!
//! Bags: topics are put on one clock, and the resulting table is then read like that of a CSV file.
//! This crate knows no file format of bags: [`Import::with_bags`] takes the function that reads
//! one.
//!
//! LeRobot: its format has columns of lists. They are written with their definition and repetition
//! levels in pyarrow's layout, with the crate `parquet` alone. Quantiles in the statistics are
//! exact; LeRobot's own are estimated from histograms.
//!
//! The crate depends on nothing that produces data: no test setup, driver of a device, emulator or
//! simulation.

mod append;
mod check;
mod error;
mod frames;
mod import;
mod lerobot;
mod missing;
mod press;
mod provenance;
mod store;

pub use error::RecordingError;
pub use frames::Frames;
pub use import::{
    Bag, BagTopic, FileSummary, Import, ImportSummary, ReadBag, guess_bag_import, guess_import,
};
pub use lerobot::LeRobotSummary;
pub use missing::null_as_nan;
pub use press::{Control, Press, Recording};
pub use provenance::Provenance;
pub use store::{Column, FrameTable, RecordingWriter, Stored, TaxelCell};
