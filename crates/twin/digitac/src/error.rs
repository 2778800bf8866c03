//! What can go wrong on the way to a twin.

use std::path::Path;

/// What was expected of the data, the simulation or the model, and what was found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DigitacError {
    /// The simulation could not deliver.
    #[error("the simulation failed: {0}")]
    Simulation(#[source] Box<dyn std::error::Error + Send + Sync>),
    /// A model's folder could not be written.
    #[error(transparent)]
    Store(#[from] twintac_store::StoreError),
    /// The simulation delivered another number of tables over depth than was asked for.
    #[error("expected {expected} tables over depth, found {found}")]
    DepthTableCount {
        /// Tables that were asked for.
        expected: usize,
        /// Tables that came.
        found: usize,
    },
    /// The simulation delivered a table over depth that can't be used.
    #[error("table over depth {index}: {source}")]
    DepthTable {
        /// Number of the request, from 0.
        index: usize,
        /// What is wrong with it.
        source: twintac_depth_table::DepthTableError,
    },
    /// A press contradicts itself, or the sensor.
    #[error("press `{press}`: {problem}")]
    Press {
        /// The press's name.
        press: String,
        /// What is wrong with it.
        problem: String,
    },
    /// There is too little to work with.
    #[error("expected {expected}, found {found}")]
    TooFew {
        /// What is needed, and for what.
        expected: String,
        /// What is there.
        found: String,
    },
    /// A setting cannot be what it is.
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
    /// Who followed the training broke it off.
    #[error("the training was stopped")]
    Stopped,
    /// A file of a model cannot be read or written.
    #[error("{path} cannot be read or written")]
    File {
        /// The file.
        path: String,
        /// What the operating system says.
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
