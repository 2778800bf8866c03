//! Errors as Python's exceptions.

use std::error::Error;
use std::path::Path;

use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;
use twintac::ErrorPlace;

/// Converts an error to the exception `twintac.Error`, with the whole text of the error.
pub(crate) trait OrRaise<T> {
    /// Returns the value, or raises the error.
    fn or_raise(self, py: Python<'_>) -> PyResult<T>;
}

impl<T, E: Into<twintac::Error>> OrRaise<T> for Result<T, E> {
    fn or_raise(self, py: Python<'_>) -> PyResult<T> {
        self.map_err(|error| {
            let error = error.into();
            exception(py, &whole_text(&error), error.place())
        })
    }
}

/// The exception for a file that cannot be read.
pub(crate) fn unreadable(py: Python<'_>, path: &Path, error: &dyn Error) -> PyErr {
    let place = ErrorPlace {
        file: Some(path.display().to_string()),
        ..ErrorPlace::default()
    };
    exception(
        py,
        &format!("reading {}: {}", path.display(), whole_text(error)),
        place,
    )
}

/// The exception for an argument that cannot be used.
pub(crate) fn unusable(py: Python<'_>, field: &str, problem: &str) -> PyErr {
    let place = ErrorPlace {
        field: Some(field.to_owned()),
        ..ErrorPlace::default()
    };
    exception(py, &format!("`{field}` {problem}"), place)
}

fn exception(py: Python<'_>, text: &str, place: ErrorPlace) -> PyErr {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let made = CLASS
        .import(py, "twintac._error", "Error")
        .and_then(|class| class.call1((text, place.file, place.line, place.field)));
    made.map_or_else(|error| error, PyErr::from_value)
}

/// The text of an error and of its sources.
fn whole_text(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut behind = error.source();
    while let Some(error) = behind {
        text = format!("{text}: {error}");
        behind = error.source();
    }
    text
}
