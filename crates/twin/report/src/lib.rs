//! The HTML page of a trained twin: predictions, errors, and the data behind them.
//!
//! [`page`] makes one self-contained page from a [`TwinReport`], which borrows the results in the
//! form in which `digitac` returns them. Units are mm, N, kPa and s; errors are in % of the largest
//! reading. Figures made from data carry a badge with their provenance.
//!
//! - [`TwinReport`]: all data of a page: the sensor, evaluated presses, compared variants
//!   ([`TrainedVariant`]), the calibration of the test setup, and how the page was made
//!   ([`Making`]).
//! - [`pressure_maps`] and [`warp_plot`]: two of its pictures, for use elsewhere.
//!
//! # How it works
//!
//! Each section of the page is a file of `sections`: the result and its comparisons, presses to
//! move through with a slider, presses over time, pressure maps, errors over the gel, by taxel and
//! by depth, recordings, variants, training losses, setup calibration, alignment, quality of the
//! simulation, the sensor's drawing, and how the page was made. A section takes what it needs from
//! the report and returns blocks (text, tables, figures) of `twintac-plot`. A section without data
//! is left out. The page contains its pictures and fetches nothing; its one script moves the
//! slider's presses. The same data give the same bytes.
//!
//! Here data are only selected and drawn; `digitac` computes the errors when it evaluates a twin.
//!
//! The crate does not depend on solvers, devices or the emulated bench.

mod sections;
mod twin_report;

pub use sections::{page, pressure_maps, warp_plot};
pub use twin_report::{Making, StageTime, TrainedVariant, TwinReport};

/// The error that the TwinTac paper reports for its twin: mean absolute error over the largest
/// contact pressure, %.
///
/// It was measured on the paper's own eight-taxel sensor, with another protocol.
const PAPER_ERROR_PERCENT: f64 = 5.95;
