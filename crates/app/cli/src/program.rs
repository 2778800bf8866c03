//! The running program.

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Result;
use twintac_work::{Caller, sha256_of_file};

use crate::progress::Bars;

/// The running program, and its arguments.
#[derive(Clone, Debug)]
pub struct Program {
    /// The file whose SHA-256 identifies the build.
    pub file: PathBuf,
    /// Its name, and the arguments after it.
    pub arguments: Vec<OsString>,
}

impl Program {
    /// The program in the form that runs need.
    pub(crate) fn caller(&self) -> Result<Caller> {
        let words: Vec<_> = self.arguments.iter().map(|word| word.to_string_lossy()).collect();
        Ok(Caller {
            program: sha256_of_file(&self.file)?,
            command: words.join(" "),
            progress: Arc::new(Bars::default()),
        })
    }
}
