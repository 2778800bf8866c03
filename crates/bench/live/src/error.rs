//! Errors of showing and recording frames.

use twintac_log::LogError;
use twintac_map::MapError;
use twintac_source::SourceError;

/// What was expected of a sensor, a terminal or a file, and what was found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LiveError {
    /// The sensor gives no frames.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// The emulated bench could not be set up.
    #[error("the emulated bench: {0}")]
    Emulate(#[from] twintac_emulate::EmulateError),
    /// Rows could not be written.
    #[error("cannot write rows: {0}")]
    Write(std::io::Error),
    /// There is no terminal to draw on.
    #[error("the dashboard: {0}; without a terminal, print rows as CSV or JSON lines")]
    Terminal(std::io::Error),
    /// A recording could not be written.
    #[error(transparent)]
    Log(#[from] LogError),
    /// A file that says how zeros move with temperature is wrong.
    #[error(transparent)]
    Compensation(#[from] twintac_config::ConfigError),
    /// A file of that kind does not match this sensor.
    #[error("{file}: {problem}")]
    OtherCompensation {
        /// The file as it was named.
        file: String,
        /// Why.
        problem: twintac_temperature::TemperatureError,
    },
    /// A map could not be prepared.
    #[error(transparent)]
    Map(#[from] MapError),
}
