//! Errors of files that are kept.

use std::io;
use std::path::{Path, PathBuf};

/// What is wrong, and with which file or folder.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoreError {
    /// A file or folder could not be used.
    #[error("{action} {}", path.display())]
    File {
        /// What was tried: `reading`, `writing`.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// A file does not contain what was written to it.
    #[error("{} is damaged", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: serde_json::Error,
    },
    /// A value could not be written as JSON.
    #[error("writing {what} as JSON")]
    Json {
        /// The file, or the name of an input.
        what: String,
        /// Why.
        source: serde_json::Error,
    },
    /// Another program works in the folder.
    #[error(
        "{} is in use by another program{by}; wait until it has ended, or give another folder",
        folder.display()
    )]
    InUse {
        /// The folder.
        folder: PathBuf,
        /// The process that works there, according to its own entry: ` (process 12)`, or empty.
        by: String,
    },
    /// A folder has contents that were made from something else.
    #[error("{} has contents that were made from another {differences}; give another folder", folder.display())]
    OtherContents {
        /// The folder.
        folder: PathBuf,
        /// Names of the inputs that differ.
        differences: String,
    },
    /// A required stage does not exist, or does not agree with its inputs.
    #[error(transparent)]
    NotCurrent(#[from] NotCurrent),
}

impl StoreError {
    /// Makes an error of a file from an error of the operating system.
    pub fn file(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::File { action, path, source }
    }
}

/// A stage that does not exist, or does not agree with its inputs.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: the stage {why}; make it with `{made_by}`", folder.display())]
pub struct NotCurrent {
    pub(crate) folder: PathBuf,
    pub(crate) why: String,
    pub(crate) made_by: &'static str,
}
