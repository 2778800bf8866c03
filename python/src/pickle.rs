//! State of values for `pickle` and `copy`, and errors of classes without it.

use pyo3::PyTypeInfo;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::unusable;

/// A value that can be restored from its state, to the last bit.
pub(crate) trait Kept: Sized {
    /// The state.
    type State: Serialize + DeserializeOwned;

    /// Returns the state.
    fn state(&self, py: Python<'_>) -> PyResult<Self::State>;

    /// Restores the value from its state.
    fn restored(py: Python<'_>, state: Self::State) -> PyResult<Self>;
}

/// The function that restores a value, and its arguments: the name of the class, and the state as
/// bytes.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, (String, Bound<'py, PyBytes>));

/// The result of `__reduce__`.
pub(crate) fn reduced<'py, T: Kept + PyTypeInfo>(py: Python<'py>, value: &T) -> PyResult<Reduced<'py>> {
    let class = T::type_object(py).name()?.to_string();
    let mut bytes = Vec::new();
    let written = ciborium::into_writer(&value.state(py)?, &mut bytes);
    written.map_err(|error| unusable(py, &class, &format!("cannot be pickled: {error}")))?;
    let restore = py.import("twintac._twintac")?.getattr("_restored")?;
    Ok((restore, (class, PyBytes::new(py, &bytes))))
}

/// Restores a value from the state that [`reduced`] wrote.
pub(crate) fn restored<T: Kept>(py: Python<'_>, class: &str, bytes: &[u8]) -> PyResult<T> {
    let state = ciborium::from_reader(bytes);
    let state = state.map_err(|error| {
        let problem = format!("was pickled by another version of twintac, and can't be read: {error}");
        unusable(py, class, &problem)
    })?;
    T::restored(py, state)
}

/// The exception of `__reduce__` in classes whose objects cannot be pickled.
pub(crate) fn refused<T>(class: &str, remedy: &str) -> PyResult<T> {
    let text = format!("a twintac.{class} can't be pickled or copied: {remedy}");
    Err(PyTypeError::new_err(text))
}
