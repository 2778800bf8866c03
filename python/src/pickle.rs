//! What `pickle` and `copy` keep of a value, and what they say of what they cannot keep.

use pyo3::PyTypeInfo;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::unusable;

/// A value that can be made again of what is kept of it, to the last bit.
pub(crate) trait Kept: Sized {
    /// What is kept.
    type State: Serialize + DeserializeOwned;

    /// What is to be kept.
    fn state(&self, py: Python<'_>) -> PyResult<Self::State>;

    /// The value, made of it.
    fn restored(py: Python<'_>, state: Self::State) -> PyResult<Self>;
}

/// The function that makes a value again, and its arguments: the name of the class, and what is kept.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, (String, Bound<'py, PyBytes>));

/// What `__reduce__` returns.
pub(crate) fn reduced<'py, T: Kept + PyTypeInfo>(py: Python<'py>, value: &T) -> PyResult<Reduced<'py>> {
    let class = T::type_object(py).name()?.to_string();
    let mut bytes = Vec::new();
    let written = ciborium::into_writer(&value.state(py)?, &mut bytes);
    written.map_err(|error| unusable(py, &class, &format!("cannot be pickled: {error}")))?;
    let restore = py.import("twintac._twintac")?.getattr("_restored")?;
    Ok((restore, (class, PyBytes::new(py, &bytes))))
}

/// A value of what `reduced` kept.
pub(crate) fn restored<T: Kept>(py: Python<'_>, class: &str, bytes: &[u8]) -> PyResult<T> {
    let state = ciborium::from_reader(bytes);
    let state = state.map_err(|error| {
        let problem = format!("was pickled by another version of twintac, and can't be read: {error}");
        unusable(py, class, &problem)
    })?;
    T::restored(py, state)
}

/// What `__reduce__` of a class raises whose objects are not values.
pub(crate) fn refused<T>(class: &str, remedy: &str) -> PyResult<T> {
    let text = format!("a twintac.{class} can't be pickled or copied: {remedy}");
    Err(PyTypeError::new_err(text))
}
