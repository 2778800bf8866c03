//! What can go wrong with recordings.

use std::path::Path;

use twintac_config::ConfigError;

/// What was expected of a recording and what was found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// A file could not be read.
    #[error("cannot read {file}: {source}")]
    Read {
        /// The file as the user named it.
        file: String,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error("cannot write {file}: {source}")]
    Write {
        /// The file as the user named it.
        file: String,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// The import description is wrong.
    #[error(transparent)]
    Description(#[from] ConfigError),
    /// A column that the import description names is not in the file.
    #[error("{file}:{line}: no column `{column}`; the file has: {found}")]
    MissingColumn {
        /// The file as the user named it.
        file: String,
        /// Line of the header, from 1.
        line: u64,
        /// The column that was looked for.
        column: String,
        /// The columns that are there.
        found: String,
    },
    /// A line of a CSV file cannot be split into the expected cells.
    #[error("{file}:{line}: {problem}")]
    Line {
        /// The file as the user named it.
        file: String,
        /// Line, from 1.
        line: u64,
        /// What is wrong with it.
        problem: String,
    },
    /// A cell of a CSV file, or a number of a bag's message, cannot be used.
    #[error("{file}:{line}: column `{column}` {problem}")]
    Cell {
        /// The file as the user named it.
        file: String,
        /// Line, or number of the topic's message, from 1.
        line: u64,
        /// Name of the column.
        column: String,
        /// What is wrong, read after the column's name.
        problem: String,
    },
    /// A column that the import description names is not in a bag, or is not what it is for.
    #[error("{file}: column `{column}` {problem}")]
    BagColumn {
        /// The file as the user named it.
        file: String,
        /// Name of the column, `/topic:field`.
        column: String,
        /// What is wrong, and what the bag has; read after the column's name.
        problem: String,
    },
    /// A bag cannot be read as the import description says.
    #[error("{file}: {problem}")]
    Bag {
        /// The file as the user named it.
        file: String,
        /// What is wrong with it, and what to do.
        problem: String,
    },
    /// What the file says cannot be, in the sense of the import description.
    #[error("{file}: {problem}")]
    Implausible {
        /// The file as the user named it.
        file: String,
        /// What is wrong with it, and what to do.
        problem: String,
    },
    /// Nothing in the file is a press, in the sense of the import description if there is one.
    #[error("{file}: found no presses in {rows} rows: {why}")]
    NoPresses {
        /// The file as the user named it.
        file: String,
        /// Rows read.
        rows: usize,
        /// What was looked for, and what became of it.
        why: String,
    },
    /// Recordings that were to become one do not belong together.
    #[error("this recording has {what} {found}, those before it {expected}; take each on its own")]
    Mixed {
        /// What differs: sensor, taxels or provenance.
        what: &'static str,
        /// That of the recordings before.
        expected: String,
        /// That of this one.
        found: String,
    },
    /// The numbers contradict what a [`Recording`](crate::Recording) promises.
    #[error("{place}: {problem}")]
    Inconsistent {
        /// The press and, where there is one, the frame.
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
