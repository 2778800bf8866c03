//! Settings as dictionaries.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;
use serde::de::DeserializeOwned;
use twintac::RunSettings;

use crate::error::{OrRaise, unusable};

/// A value of Python as JSON has it.
pub(crate) fn from_python<T: DeserializeOwned>(value: &Bound<'_, PyAny>, name: &str) -> PyResult<T> {
    let py = value.py();
    let text: String = py.import("json")?.call_method1("dumps", (value,))?.extract()?;
    serde_json::from_str(&text).map_err(|error| unusable(py, name, &format!("does not fit: {error}")))
}

/// Values but for those of a dictionary.
pub(crate) fn over<T: Serialize + DeserializeOwned>(
    base: &T,
    own: Option<&Bound<'_, PyDict>>,
    py: Python<'_>,
) -> PyResult<T> {
    let all = to_python(py, base)?;
    if let Some(own) = own {
        all.call_method1("update", (own,))?;
    }
    from_python(&all, "settings")
}

/// Anything that can be written as JSON, as Python has it.
pub(crate) fn to_python<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| unusable(py, "value", &error.to_string()))?;
    py.import("json")?.call_method1("loads", (text,))
}

/// The text of a TOML file with these values.
pub(crate) fn as_toml(values: &Bound<'_, PyAny>) -> PyResult<String> {
    let table: toml::Table = from_python(values, "settings")?;
    toml::to_string(&table).map_err(|error| unusable(values.py(), "settings", &error.to_string()))
}

/// Settings but for those of a dictionary with a dictionary for each stage.
pub(crate) fn but(base: RunSettings, own: Option<&Bound<'_, PyDict>>) -> PyResult<RunSettings> {
    let Some(own) = own else {
        return Ok(base);
    };
    base.but_parsed("settings", &as_toml(own)?).or_raise(own.py())
}
