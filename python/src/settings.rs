//! Settings as dictionaries.

use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Number, Value};
use twintac::{RunSettings, WorkError};

use crate::error::{OrRaise, unusable};

/// Most levels of nested lists and dictionaries. A list that contains itself would never end.
const DEEPEST: usize = 16;

/// Settings, with the values of keywords in place of their own.
pub(crate) fn over<T: Serialize + DeserializeOwned>(
    base: T,
    own: Option<&Bound<'_, PyDict>>,
    py: Python<'_>,
) -> PyResult<T> {
    let mut settings = base;
    for (name, own) in own.into_iter().flatten() {
        let name: String = name.extract()?;
        let misfit = |error: serde_json::Error| unusable(py, &name, &format!("does not fit: {error}"));
        let mut all: Map<String, Value> = serde_json::to_value(&settings)
            .and_then(serde_json::from_value)
            .map_err(misfit)?;
        let Some(value) = all.get_mut(&name) else {
            let names: Vec<&str> = all.keys().map(String::as_str).collect();
            let problem = format!("is no setting; there are {}", names.join(", "));
            return Err(unusable(py, &name, &problem));
        };
        *value = value_of(&own, &name, DEEPEST)?;
        settings = serde_json::from_value(Value::Object(all)).map_err(misfit)?;
    }
    Ok(settings)
}

/// A number, a text, or a list or dictionary of these, of Python or of NumPy, as JSON. `name` is
/// the field that contains it.
fn value_of(value: &Bound<'_, PyAny>, name: &str, deepest: usize) -> PyResult<Value> {
    let Some(below) = deepest.checked_sub(1) else {
        return Err(unusable(
            value.py(),
            name,
            &format!("has more than {DEEPEST} lists or dictionaries in each other"),
        ));
    };
    if let Ok(flag) = value.cast::<PyBool>() {
        return Ok(flag.is_true().into());
    }
    if let Ok(number) = value.cast::<PyInt>() {
        let integer = number.extract::<i64>().map_err(|_| {
            let problem = format!(
                "is {number}, expected an integer from {} to {}",
                i64::MIN,
                i64::MAX
            );
            unusable(value.py(), name, &problem)
        });
        return Ok(integer?.into());
    }
    if let Ok(number) = value.cast::<PyFloat>() {
        let number: f64 = number.extract()?;
        let finite = Number::from_f64(number).map(Value::Number);
        let refused = || {
            unusable(
                value.py(),
                name,
                &format!("is {number}, expected a finite number"),
            )
        };
        return finite.ok_or_else(refused);
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(text.extract::<String>()?.into());
    }
    if let Ok(values) = value.cast::<PyDict>() {
        return Ok(Value::Object(values_of(values, name, below)?));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let each = value.try_iter()?.map(|value| value_of(&value?, name, below));
        return Ok(Value::Array(each.collect::<PyResult<_>>()?));
    }
    if value.hasattr("tolist")? {
        return value_of(&value.call_method0("tolist")?, name, below); // a NumPy object
    }
    if value.hasattr("__fspath__")? {
        return value_of(&value.call_method0("__fspath__")?, name, below);
    }
    let kind = value.get_type().name()?;
    let problem = format!("is of type {kind}, expected a number, a text, a list or a dictionary");
    Err(unusable(value.py(), name, &problem))
}

fn values_of(values: &Bound<'_, PyDict>, within: &str, deepest: usize) -> PyResult<Map<String, Value>> {
    let named = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| -> PyResult<(String, Value)> {
        let name: String = name.extract().map_err(|_| {
            let within = if within.is_empty() { "settings" } else { within };
            unusable(
                values.py(),
                within,
                &format!("has the key {name}, expected a text"),
            )
        })?;
        let path = match within {
            "" => name.clone(),
            _ => format!("{within}.{name}"),
        };
        Ok((name, value_of(&value, &path, deepest)?))
    };
    values.iter().map(named).collect()
}

/// A value as Python objects, by way of JSON.
pub(crate) fn to_python<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| unusable(py, "value", &error.to_string()))?;
    py.import("json")?.call_method1("loads", (text,))
}

/// The text of a TOML file with these values, in a table if it has a name.
pub(crate) fn as_toml(py: Python<'_>, values: Option<&Bound<'_, PyDict>>, table: &str) -> PyResult<String> {
    let mut all = values.map_or_else(|| Ok(Map::new()), |values| values_of(values, "", DEEPEST))?;
    if !table.is_empty() {
        all = Map::from_iter([(table.to_owned(), Value::Object(all))]);
    }
    let table = toml::Table::try_from(&all);
    let text = table.and_then(|table| toml::to_string(&table));
    text.map_err(|error| unusable(py, "settings", &error.to_string()))
}

/// The exception for a value in such a text that is not allowed. It names the keyword.
pub(crate) fn refused(py: Python<'_>, table: &str, [field, problem, hint]: [&str; 3]) -> PyErr {
    let of_table = field
        .strip_prefix(table)
        .and_then(|field| field.strip_prefix('.'));
    unusable(py, of_table.unwrap_or(field), &format!("{problem}; {hint}"))
}

/// Settings, with the values of a dictionary in place of their own. It has a dictionary for each
/// stage, or is the dictionary of one stage.
pub(crate) fn but(
    py: Python<'_>,
    base: RunSettings,
    own: Option<&Bound<'_, PyDict>>,
    stage: &str,
) -> PyResult<RunSettings> {
    match base.but_parsed("settings", &as_toml(py, own, stage)?) {
        Err(WorkError::Config(error)) => Err(refused(py, stage, [&error.field, &error.problem, &error.hint])),
        settings => settings.or_raise(py),
    }
}
