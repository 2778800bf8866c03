//! What can go wrong between numbers and a picture on disk.

use std::path::PathBuf;

/// Why a picture or a page could not be made or written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// Two inputs that belong together differ in length, or a setting is out of its range.
    #[error("{what}: expected {expected}, found {found}")]
    Input {
        /// The input that is wrong.
        what: &'static str,
        /// What it should have been.
        expected: String,
        /// What it was.
        found: String,
    },
    /// The interpolation through the taxels has no unique solution.
    #[error("the pressure map cannot meet the taxels' values: two taxels share a place (pivot {pivot:e})")]
    Singular {
        /// The pivot that vanished, relative to a diagonal of one.
        pivot: f64,
    },
    /// A picture could not be rasterised.
    #[error("a picture of {width_px} x {height_px} pixels could not be drawn: {reason}")]
    Raster {
        /// Requested width in pixels.
        width_px: f64,
        /// Requested height in pixels.
        height_px: f64,
        /// What the rasteriser said.
        reason: String,
    },
    /// A file could not be written.
    #[error("{path} could not be written: {source}")]
    Write {
        /// The file that was to be written.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}
