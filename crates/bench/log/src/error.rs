//! Errors of logs.

use std::path::Path;

use twintac_recording::RecordingError;

use crate::Stream;

/// What was expected of a log and what was found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LogError {
    /// A log could not be created, written or renamed to its final name. What was flushed before is
    /// readable.
    #[error("cannot write {file}: {source}")]
    Write {
        /// The file as the user named it.
        file: String,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A log could not be read.
    #[error("cannot read {file}: {source}")]
    Read {
        /// The file as the user named it.
        file: String,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A log would replace another file.
    #[error("{file} exists already; a log never replaces a file")]
    Exists {
        /// The file that exists.
        file: String,
    },
    /// The file is no log, or was cut before the end of its description.
    #[error("{file} is not a readable log: {problem}")]
    NotALog {
        /// The file as the user named it.
        file: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A description or a message cannot be written.
    #[error("{what}: {problem}")]
    Invalid {
        /// The field or the kind of message.
        what: &'static str,
        /// What is wrong with it.
        problem: String,
    },
    /// The disk is too slow: this message is lost. The log marks the gap as soon as there is room.
    #[error("the log does not keep up: {queued} messages wait, one of {stream} is lost")]
    Behind {
        /// The stream of the lost message.
        stream: Stream,
        /// Number of messages that wait to be written.
        queued: usize,
    },
    /// The log accepts no more messages: it was finished, or an earlier write failed.
    #[error("the log takes no more messages: {why}")]
    Stopped {
        /// Why.
        why: String,
    },
    /// Presses in a log need the indenter's pose, and the log has none.
    #[error("{file} has no robot poses, so that the locations of its presses are unknown")]
    NoPoses {
        /// The file as the user named it.
        file: String,
    },
    /// The presses that were read back contradict each other.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

impl LogError {
    pub(crate) fn read(file: &Path, source: std::io::Error) -> Self {
        Self::Read {
            file: file.display().to_string(),
            source,
        }
    }

    pub(crate) fn write(file: &Path, source: std::io::Error) -> Self {
        Self::Write {
            file: file.display().to_string(),
            source,
        }
    }
}
