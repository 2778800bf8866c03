//! Errors of a characterization.

use std::path::PathBuf;

use twintac_plot::PlotError;

/// Why there is no characterization.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CharacterizeError {
    /// The recordings are of another sensor than described.
    #[error(
        "the recordings are of sensor `{found}` with taxels {found_taxels}; the description is of `{expected}` with {expected_taxels}"
    )]
    OtherSensor {
        /// The recordings' sensor.
        found: String,
        /// The recordings' taxels.
        found_taxels: String,
        /// The description's sensor.
        expected: String,
        /// The description's taxels.
        expected_taxels: String,
    },
    /// There is nothing to characterize.
    #[error("the recordings hold neither presses nor frames outside of presses")]
    NothingRecorded,
    /// A folder could not be made.
    #[error("{path} could not be made: {source}")]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// A page could not be written.
    #[error(transparent)]
    Page(#[from] PlotError),
}
