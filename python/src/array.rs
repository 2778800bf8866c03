//! Arrays in and out.

use std::borrow::Cow;

use numpy::ndarray::{Dimension, Ix1};
use numpy::{AllowTypeChange, Element, PyArray1, PyArray2, PyArrayLike, PyArrayMethods};
use pyo3::prelude::*;

use crate::error::unusable;

/// Numbers of an array of any type and layout.
pub(crate) type Numbers<'py, D> = PyArrayLike<'py, f64, D, AllowTypeChange>;

/// An array's numbers in the order of its indices, copied if they are not in memory like this.
pub(crate) fn in_order<'a, D: Dimension>(numbers: &'a Numbers<'_, D>) -> Cow<'a, [f64]> {
    let numbers = numbers.as_array();
    let in_memory = numbers.to_slice().map(Cow::Borrowed);
    in_memory.unwrap_or_else(|| Cow::Owned(numbers.iter().copied().collect()))
}

/// As many numbers as are expected.
pub(crate) fn few<const N: usize>(
    py: Python<'_>,
    field: &str,
    numbers: &Numbers<'_, Ix1>,
) -> PyResult<[f64; N]> {
    let numbers = in_order(numbers);
    let refused = |_| unusable(py, field, &format!("has {} numbers, expected {N}", numbers.len()));
    <[f64; N]>::try_from(&*numbers).map_err(refused)
}

/// Numbers as `[n_rows, n_columns]`.
pub(crate) fn rows<T: Element>(
    py: Python<'_>,
    numbers: Vec<T>,
    shape: [usize; 2],
) -> PyResult<Bound<'_, PyArray2<T>>> {
    PyArray1::from_vec(py, numbers).reshape(shape)
}

/// Rows of one length as `[n_rows, n_columns]`.
pub(crate) fn of_rows<'py, T: Element + Copy>(
    py: Python<'py>,
    all: &[Vec<T>],
    n_columns: usize,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    rows(py, all.concat(), [all.len(), n_columns])
}
