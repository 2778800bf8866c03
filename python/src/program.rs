//! This package as the program that does the work of runs.

use std::path::PathBuf;

use pyo3::prelude::*;
use twintac::{Caller, sha256_of_file};
use twintac_cli::Program;

use crate::error::OrRaise;

/// The package's own file, which identifies the build, and Python's arguments.
fn program(py: Python<'_>) -> PyResult<Program> {
    let file: PathBuf = py.import("twintac._twintac")?.getattr("__file__")?.extract()?;
    let arguments = py.import("sys")?.getattr("argv")?.extract()?;
    Ok(Program { file, arguments })
}

/// Runs the command line (`sys.argv`) as the command `twintac` does. Returns the exit code: 0 on
/// success, 2 for bad input, 3 if a test setup was stopped safely.
#[pyfunction]
pub(crate) fn command(py: Python<'_>) -> PyResult<u8> {
    let program = program(py)?;
    Ok(py.detach(|| program.run()))
}

/// This package, for runs without progress reports.
pub(crate) fn caller(py: Python<'_>) -> PyResult<Caller> {
    let Program { file, arguments } = program(py)?;
    let words: Vec<_> = arguments.iter().map(|word| word.to_string_lossy()).collect();
    Ok(Caller {
        program: py.detach(|| sha256_of_file(&file)).or_raise(py)?,
        command: format!("python {}", words.join(" ")),
        ..Caller::default()
    })
}
