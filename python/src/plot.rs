//! Plots with Matplotlib: `twintac/_plot.py` draws them.

use pyo3::call::PyCallArgs;
use pyo3::prelude::*;

/// Plots a result, and returns its axes.
pub(crate) fn plot<'py>(
    py: Python<'py>,
    what: &str,
    arguments: impl PyCallArgs<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    py.import("twintac._plot")?.call_method1(what, arguments)
}
