//! What can go wrong beside the bench itself.

use std::path::Path;

use twintac_config::ConfigError;
use twintac_log::LogError;
use twintac_rig::RigError;

/// Why a run did not begin, or could not be recorded. What stops the bench is a [`Cause`](twintac_rig::Cause) instead.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PressError {
    /// The bench settings are wrong.
    #[error(transparent)]
    Settings(#[from] ConfigError),
    /// The supervisor refuses the settings.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// A log could not be written or read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// A file of the run's folder could not be read or written.
    #[error("{file}: {source}")]
    File {
        /// The file.
        file: String,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// The folder holds another run.
    #[error("{folder} holds a run of other presses: {problem}; choose another folder")]
    OtherRun {
        /// The folder.
        folder: String,
        /// What differs.
        problem: String,
    },
    /// No thread could be started.
    #[error("no thread for {what}: {source}")]
    Thread {
        /// What it is for.
        what: &'static str,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A planned press has a number that cannot be carried out.
    #[error("press `{press}`: `{field}` is {found}")]
    Plan {
        /// The press.
        press: String,
        /// The field.
        field: &'static str,
        /// Its value.
        found: f64,
    },
}

impl PressError {
    pub(crate) fn file(file: &Path, source: std::io::Error) -> Self {
        let file = file.display().to_string();
        Self::File { file, source }
    }
}
