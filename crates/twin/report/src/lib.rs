//! The page of a trained twin: what it predicts, how well, and what stands behind it.
//!
//! [`page`] makes one self-contained HTML page of a [`TwinReport`], which borrows the results as `digitac` gives them.
//! This crate chooses and draws; errors are computed where the twin is judged.

mod sections;
mod twin_report;

pub use sections::{page, pressure_maps, warp_plot};
pub use twin_report::{Making, StageTime, TrainedVariant, TwinReport};

/// The twin's error that the TwinTac paper reports: mean absolute error over the largest contact pressure, %.
///
/// It was measured on the paper's own eight-taxel sensor, over another protocol.
const PAPER_ERROR_PERCENT: f64 = 5.95;
