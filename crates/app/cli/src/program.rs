//! The program that commands are part of.

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Result;
use twintac_work::{Caller, sha256_of_file};

use crate::progress::Bars;

/// The program that commands are part of, and what it was started with.
#[derive(Clone, Debug)]
pub struct Program {
    /// The file that tells one build from another.
    pub file: PathBuf,
    /// Its name, and what was typed behind it.
    pub arguments: Vec<OsString>,
}

impl Program {
    /// The program as runs know it.
    pub(crate) fn caller(&self) -> Result<Caller> {
        let words: Vec<_> = self.arguments.iter().map(|word| word.to_string_lossy()).collect();
        Ok(Caller {
            program: sha256_of_file(&self.file)?,
            command: words.join(" "),
            progress: Arc::new(Bars::default()),
        })
    }
}
