//! Data on standard output; what is for people goes to standard error.

use std::io::{ErrorKind, Write};

use anyhow::Result;

/// A figure in %, in a column of so many characters and two decimals: "none" over nothing.
pub(crate) fn percent(value: Option<f64>) -> String {
    match value {
        Some(value) => format!("{value:6.2} %"),
        None => "    none".to_owned(),
    }
}

/// Prints a line of data to standard output; a closed pipe is no error.
pub(crate) fn print(text: &str) -> Result<()> {
    match writeln!(std::io::stdout(), "{text}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
