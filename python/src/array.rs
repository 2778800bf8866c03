//! NumPy arrays as results.

use numpy::{Element, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

/// Values as an array `[n_rows, n_columns]`.
pub(crate) fn rows<T: Element>(
    py: Python<'_>,
    numbers: Vec<T>,
    shape: [usize; 2],
) -> PyResult<Bound<'_, PyArray2<T>>> {
    PyArray1::from_vec(py, numbers).reshape(shape)
}

/// Rows of equal length as an array `[n_rows, n_columns]`.
pub(crate) fn of_rows<'py, T: Element + Copy>(
    py: Python<'py>,
    all: &[Vec<T>],
    n_columns: usize,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    rows(py, all.concat(), [all.len(), n_columns])
}
