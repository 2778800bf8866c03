//! Completes a log that was cut.

use std::path::{Path, PathBuf};

use crate::sink::LogFile;
use crate::{Body, Ending, Event, LogError, LogReader, LogWriter, Message};

/// Result of a recovery.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recovered {
    /// The complete file.
    pub path: PathBuf,
    /// Messages of the old file that it contains.
    pub messages: u64,
    /// How the old file ends.
    pub ending: Ending,
}

/// Writes everything that can be read of a log into a complete file beside it, through a temporary
/// name. The old file is kept.
///
/// The complete file of `<name>.partial` is `<name>`, that of any other file is
/// `<stem>.recovered.mcap`. What was damaged on the disk becomes a gap, and so does the end of a
/// file that was cut.
///
/// # Errors
/// A file that cannot be read or is no log; a complete file that exists already or cannot be
/// written.
pub fn recover(path: &Path) -> Result<Recovered, LogError> {
    let mut reader = LogReader::open(path)?;
    let is_partial = path.extension().is_some_and(|extension| extension == "partial");
    let whole = path.with_extension(if is_partial { "" } else { "recovered.mcap" });
    let mut writer = LogWriter::new(LogFile::remake(&whole)?, reader.description())?;
    let mut messages = 0;
    let mut last_ns = 0;
    for message in &mut reader {
        let message = message?;
        last_ns = message.bench_ns.max(last_ns);
        writer.write(&message)?;
        messages += 1;
    }
    let ending = reader.ending().unwrap_or(Ending::Cut);
    if ending == Ending::Cut {
        let gap = Event::Gap {
            stream: None,
            cause: "the file was cut here".to_owned(),
            from_ns: last_ns,
            to_ns: last_ns,
            lost: None,
        };
        writer.write(&Message {
            bench_ns: last_ns,
            body: Body::Event(gap),
        })?;
    }
    writer.finish()?;
    Ok(Recovered {
        path: whole,
        messages,
        ending,
    })
}
