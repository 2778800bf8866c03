//! The program that runs the work.

use std::fmt;
use std::sync::Arc;

use crate::{Progress, Silent};

/// The program that runs the work.
#[derive(Clone)]
pub struct Caller {
    /// Identifies the build of the program. A stage that another build made is run again, because
    /// that build may compute something else. The command line gives the SHA-256 of its own file.
    /// The default is the version of this library.
    pub program: String,
    /// The command that the report names as its origin.
    pub command: String,
    /// Receives the progress of the work.
    pub progress: Arc<dyn Progress>,
}

impl Default for Caller {
    /// A program that uses this library and ignores all reports of progress.
    fn default() -> Self {
        let name = concat!("twintac ", env!("CARGO_PKG_VERSION"));
        Self {
            program: name.to_owned(),
            command: name.to_owned(),
            progress: Arc::new(Silent),
        }
    }
}

impl fmt::Debug for Caller {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Caller")
            .field("program", &self.program)
            .field("command", &self.command)
            .finish_non_exhaustive()
    }
}
