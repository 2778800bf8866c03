//! A whole file of one that was cut.

use std::path::{Path, PathBuf};

use crate::sink::LogFile;
use crate::{Ending, LogError, LogReader, LogWriter};

/// What was recovered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recovered {
    /// The whole file.
    pub path: PathBuf,
    /// Messages in it.
    pub messages: u64,
    /// How the old file ends.
    pub ending: Ending,
}

/// Writes all that can be read of a log into a whole one beside it, through a temporary name; the old file stays.
///
/// The whole one of `<name>.partial` is `<name>`, that of any other file `<stem>.recovered.mcap`. What was damaged on the disk
/// becomes a gap.
///
/// # Errors
/// A file that cannot be read or is no log; a whole one that exists already or cannot be written.
pub fn recover(path: &Path) -> Result<Recovered, LogError> {
    let mut reader = LogReader::open(path)?;
    let is_partial = path.extension().is_some_and(|extension| extension == "partial");
    let whole = path.with_extension(if is_partial { "" } else { "recovered.mcap" });
    let mut writer = LogWriter::new(LogFile::remake(&whole)?, reader.description())?;
    let mut messages = 0;
    for message in &mut reader {
        writer.write(&message?)?;
        messages += 1;
    }
    writer.finish()?;
    Ok(Recovered {
        path: whole,
        messages,
        ending: reader.ending().unwrap_or(Ending::Cut),
    })
}
