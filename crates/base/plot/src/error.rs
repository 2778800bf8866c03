//! What can go wrong between a scene and a picture on disk.

use std::path::PathBuf;

/// Why a picture or a page could not be made or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlotError {
    /// The file's ending names no format.
    #[error("{path}: a picture's file ends in .svg or .png")]
    Format {
        /// The file that was to be written.
        path: PathBuf,
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
    #[error("{path} could not be written")]
    Write {
        /// The file that was to be written.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

impl PlotError {
    /// Writes bytes to a file, whole or not at all.
    pub(crate) fn write_whole(path: &std::path::Path, bytes: &[u8]) -> Result<(), Self> {
        twintac_store::write_whole(path, bytes).map_err(|source| PlotError::Write {
            path: path.to_owned(),
            source,
        })
    }
}
