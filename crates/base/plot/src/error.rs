//! Errors of pictures and pages.

use std::path::PathBuf;

/// Why a picture or a page could not be made or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlotError {
    /// The extension of the file name is not that of a known format.
    #[error("{path}: the name of a picture must end in .svg or .png")]
    Format {
        /// The file that should have been written.
        path: PathBuf,
    },
    /// A picture could not be rasterised.
    #[error("a picture of {width_px} x {height_px} pixels could not be drawn: {reason}")]
    Raster {
        /// Requested width in pixels.
        width_px: f64,
        /// Requested height in pixels.
        height_px: f64,
        /// Message of the rasteriser.
        reason: String,
    },
    /// A file could not be written.
    #[error("{path} could not be written")]
    Write {
        /// The file that should have been written.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
}

impl PlotError {
    /// Writes bytes to a file, which appears complete or not at all.
    pub(crate) fn write_whole(path: &std::path::Path, bytes: &[u8]) -> Result<(), Self> {
        twintac_store::write_whole(path, bytes).map_err(|source| PlotError::Write {
            path: path.to_owned(),
            source,
        })
    }
}
