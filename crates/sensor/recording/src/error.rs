//! Errors of recordings.

use std::path::Path;

use twintac_config::ConfigError;

/// Why a recording cannot be read, written or used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// A file could not be read.
    #[error("cannot read {file}: {source}")]
    Read {
        /// The file as the user named it.
        file: String,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error("cannot write {file}: {source}")]
    Write {
        /// The file as the user named it.
        file: String,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// The import description is wrong.
    #[error(transparent)]
    Description(#[from] ConfigError),
    /// A column named in the import description is not in the file.
    #[error("{file}:{line}: no column `{column}`; the file has: {found}")]
    MissingColumn {
        /// The file as the user named it.
        file: String,
        /// Line of the header, from 1.
        line: u64,
        /// The column that was looked for.
        column: String,
        /// The columns of the file.
        found: String,
    },
    /// A line of a CSV file does not have the expected cells.
    #[error("{file}:{line}: {problem}")]
    Line {
        /// The file as the user named it.
        file: String,
        /// Line, from 1.
        line: u64,
        /// What is wrong with it.
        problem: String,
    },
    /// A cell of a CSV file, or a number in a message of a bag, cannot be used.
    #[error("{file}:{line}: column `{column}` {problem}")]
    Cell {
        /// The file as the user named it.
        file: String,
        /// Line of the file, or number of the message in its topic, from 1.
        line: u64,
        /// Name of the column.
        column: String,
        /// What is wrong; it follows the column's name.
        problem: String,
    },
    /// A column named in the import description is not in a bag, or does not suit its purpose.
    #[error("{file}: column `{column}` {problem}")]
    BagColumn {
        /// The file as the user named it.
        file: String,
        /// Name of the column, `/topic:field`.
        column: String,
        /// What is wrong, and what the bag contains; it follows the column's name.
        problem: String,
    },
    /// A bag cannot be read by the import description.
    #[error("{file}: {problem}")]
    Bag {
        /// The file as the user named it.
        file: String,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// A press is there twice.
    #[error(
        "press `{press}` has the same times, poses and readings as `{of}`, to the last digit: the same recording was given twice; leave one of them out"
    )]
    Repeated {
        /// The press that was to be added.
        press: String,
        /// The press that it is a copy of.
        of: String,
    },
    /// By the import description, the content of the file is impossible.
    #[error("{file}: {problem}")]
    Implausible {
        /// The file as the user named it.
        file: String,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// The file contains no press, by the import description if there is one.
    #[error("{file}: found no presses in {rows} rows: {why}")]
    NoPresses {
        /// The file as the user named it.
        file: String,
        /// Rows read.
        rows: usize,
        /// How presses were searched for, and what was found.
        why: String,
    },
    /// Recordings that were to be joined do not match.
    #[error("this recording has {what} {found}, the previous ones have {expected}; use each on its own")]
    Mixed {
        /// What differs: sensor, taxels or provenance.
        what: &'static str,
        /// The value of the recordings before.
        expected: String,
        /// The value of this recording.
        found: String,
    },
    /// The numbers break a condition of [`Recording`](crate::Recording).
    #[error("{place}: {problem}")]
    Inconsistent {
        /// The press, and the frame if there is one.
        place: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A Parquet file is truncated, altered, or not a recording.
    #[error("{file} is not a readable recording: {problem}")]
    Damaged {
        /// The file as the user named it.
        file: String,
        /// What is wrong with it.
        problem: String,
    },
}

impl RecordingError {
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
