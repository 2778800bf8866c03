//! Errors of making and using a twin.

use std::path::Path;

/// What was expected of the data, the simulation or the model, and what was found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DigitacError {
    /// The simulation failed.
    #[error("the simulation failed: {0}")]
    Simulation(#[source] Box<dyn std::error::Error + Send + Sync>),
    /// A model's folder could not be written.
    #[error(transparent)]
    Store(#[from] twintac_store::StoreError),
    /// The number of tables over depth from the simulation differs from the number of requests.
    #[error("expected {expected} tables over depth, found {found}")]
    DepthTableCount {
        /// Requested tables.
        expected: usize,
        /// Tables that were delivered.
        found: usize,
    },
    /// The simulation delivered a table over depth that cannot be used.
    #[error("table over depth {index}: {source}")]
    DepthTable {
        /// Number of the request, from 0.
        index: usize,
        /// What is wrong with it.
        source: twintac_depth_table::DepthTableError,
    },
    /// A press that is inconsistent, or that does not match the sensor.
    #[error("press `{press}`: {problem}")]
    Press {
        /// The press's name.
        press: String,
        /// What is wrong with it.
        problem: String,
    },
    /// There are too few presses or other data.
    #[error("expected {expected}, found {found}")]
    TooFew {
        /// What is needed, and for what.
        expected: String,
        /// What is there.
        found: String,
    },
    /// A setting outside its range.
    #[error("setting {0}")]
    Setting(#[from] twintac_config::Problem),
    /// The loss became infinite or NaN.
    #[error("training of variant `{variant}` diverged in epoch {epoch}: the loss is {loss}")]
    Diverged {
        /// The variant.
        variant: String,
        /// Epoch, from 0.
        epoch: usize,
        /// The loss.
        loss: f64,
    },
    /// The training was stopped by its caller.
    #[error("the training was stopped")]
    Stopped,
    /// A file of a model cannot be read or written.
    #[error("{path} cannot be read or written")]
    File {
        /// The file.
        path: String,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// A model is incomplete, altered, or of another version.
    #[error("{path} is not a usable model: {problem}")]
    Model {
        /// The folder or file.
        path: String,
        /// What is wrong with it.
        problem: String,
    },
}

impl DigitacError {
    pub(crate) fn file(path: &Path, source: std::io::Error) -> Self {
        Self::File {
            path: path.display().to_string(),
            source,
        }
    }

    pub(crate) fn model(path: &Path, problem: impl Into<String>) -> Self {
        Self::Model {
            path: path.display().to_string(),
            problem: problem.into(),
        }
    }

    pub(crate) fn press(press: &str, problem: impl Into<String>) -> Self {
        Self::Press {
            press: press.to_owned(),
            problem: problem.into(),
        }
    }
}
