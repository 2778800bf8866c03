//! Who runs the stages.

use std::fmt;
use std::sync::Arc;

use crate::{Progress, Silent};

/// The program that a run is worked on with.
#[derive(Clone)]
pub struct Caller {
    /// Tells one build of the program from another: a stage that another build made is run again, as that one may compute something else.
    /// The command line gives the SHA-256 of its own file. By default it is the version of this library.
    pub program: String,
    /// What the report names as the command that made it.
    pub command: String,
    /// Hears how the work goes.
    pub progress: Arc<dyn Progress>,
}

impl Default for Caller {
    /// A program that uses this library and hears nothing.
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
