//! Places in texts that committed figures fill.
//!
//! A place is `{NAME PATH DECIMALS}`, where `NAME` is a file. A path goes down by keys, indices, or
//! fields that an element of an array must have (`rows/held_out=place & without=null/twin`); `*`
//! takes all elements. `mean(PATH)`, `sum(PATH)`, `min(PATH)`, `max(PATH)` and `count(PATH)` take a
//! list together, in which `true` is 1. `spread(PATH)` is a mean and its deviation.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;

use crate::documents::read;

/// The contents of files, by their short names.
pub(super) fn values<'a>(
    root: &Path,
    from: &'a BTreeMap<String, String>,
) -> Result<BTreeMap<&'a str, Value>> {
    let mut values = BTreeMap::new();
    for (name, file) in from {
        let value: Value =
            serde_json::from_str(&read(root, file)?).with_context(|| format!("reading {file}"))?;
        values.insert(name.as_str(), value);
    }
    Ok(values)
}

/// A text with its places filled.
pub(super) fn filled(text: &str, values: &BTreeMap<&str, Value>) -> Result<String> {
    let mut filled = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        let (place, after) = after
            .split_once('}')
            .with_context(|| format!("`{text}`: a place has no end"))?;
        filled += before;
        filled += &number(place, values).with_context(|| format!("the place `{{{place}}}`"))?;
        rest = after;
    }
    Ok(filled + rest)
}

/// The number of one place.
fn number(place: &str, values: &BTreeMap<&str, Value>) -> Result<String> {
    let (name, rest) = place.split_once(' ').context("has no path")?;
    let (path, decimals) = rest.rsplit_once(' ').context("has no decimals")?;
    let decimals: usize = decimals.parse().context("decimals")?;
    let value = values
        .get(name)
        .with_context(|| format!("`{name}` is not in `from`"))?;
    let (how, path) = match path.strip_suffix(')').and_then(|path| path.split_once('(')) {
        Some((how, path)) => (how, path),
        None => ("", path),
    };
    if how == "spread" {
        let of = |key: &str| number(&format!("{name} {path}/{key} {decimals}"), values);
        return Ok(format!("{} ± {}", of("mean_percent")?, of("deviation_percent")?));
    }
    let found: Vec<&Value> = found(value, path)?
        .into_iter()
        .flat_map(|value| match value {
            Value::Array(values) => values.iter().collect(),
            value => vec![value],
        })
        .collect();
    let number = if how == "count" {
        found.len() as f64
    } else {
        let numbers: Vec<f64> = found.into_iter().map(as_number).collect::<Result<_>>()?;
        taken_together(how, &numbers)?
    };
    Ok(grouped(&format!("{number:.decimals$}")))
}

/// A number whose thousands are separated, from five digits on.
fn grouped(number: &str) -> String {
    let (whole, rest) = number
        .split_once('.')
        .map_or((number, String::new()), |(whole, part)| {
            (whole, format!(".{part}"))
        });
    if whole.trim_start_matches('-').len() < 5 {
        return number.to_owned();
    }
    let n = whole.len();
    let digits = whole.chars().enumerate().map(|(at, digit)| {
        let is_first = at == 0 || (n - at) % 3 != 0 || &whole[..at] == "-";
        if is_first {
            digit.to_string()
        } else {
            format!(",{digit}")
        }
    });
    digits.collect::<String>() + &rest
}

fn as_number(value: &Value) -> Result<f64> {
    match value {
        Value::Bool(is) => Ok(f64::from(u8::from(*is))),
        value => value.as_f64().with_context(|| format!("{value} is no number")),
    }
}

fn taken_together(how: &str, numbers: &[f64]) -> Result<f64> {
    ensure!(!numbers.is_empty(), "nothing is found");
    Ok(match how {
        "" => {
            ensure!(numbers.len() == 1, "{} numbers, not one", numbers.len());
            numbers[0]
        }
        "mean" => numbers.iter().sum::<f64>() / numbers.len() as f64,
        "sum" => numbers.iter().sum(),
        "min" => numbers.iter().copied().fold(f64::INFINITY, f64::min),
        "max" => numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        _ => bail!("there is no `{how}`"),
    })
}

/// What a path leads to.
fn found<'a>(value: &'a Value, path: &str) -> Result<Vec<&'a Value>> {
    let mut at = vec![value];
    for step in path.split('/') {
        let mut next = Vec::new();
        for value in at {
            match value {
                Value::Array(values) if step == "*" => next.extend(values),
                Value::Array(values) if step.contains('=') => {
                    next.extend(values.iter().find(|value| has(value, step)));
                }
                Value::Array(values) => {
                    next.extend(step.parse().ok().and_then(|index: usize| values.get(index)))
                }
                value => next.extend(value.get(step)),
            }
        }
        ensure!(!next.is_empty(), "there is no `{step}`");
        at = next;
    }
    Ok(at)
}

/// Whether a value has all of the fields, written `KEY=VALUE & KEY=VALUE`.
fn has(value: &Value, fields: &str) -> bool {
    let shown = |value: &Value| match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    fields.split(" & ").all(|field| {
        let field = field.split_once('=');
        field.is_some_and(|(key, wanted)| shown(&value[key]) == wanted)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values() -> BTreeMap<&'static str, Value> {
        let value = serde_json::json!({
            "rows": [{"by": "place", "n": 1, "error": 0.951}, {"by": "file", "n": 1, "error": 3.0}],
            "seeds": [1.0, 2.0, 6.0], "all": {"mean_percent": 1.234, "deviation_percent": 0.1}, "lifted": [{"is": true}, {"is": false}],
        });
        BTreeMap::from([("a", value)])
    }

    #[test]
    fn places_are_filled() {
        let text = "{a rows/by=place & n=1/error 2} %, {a mean(seeds) 1}, {a sum(lifted/*/is) 0} of {a count(lifted) 0}, {a spread(all) 2}";
        assert_eq!(
            filled(text, &values()).unwrap(),
            "0.95 %, 3.0, 1 of 2, 1.23 ± 0.10"
        );
        assert_eq!(
            ["1234", "515564", "-51556.4"].map(grouped),
            ["1234", "515,564", "-51,556.4"]
        );
    }

    #[test]
    fn what_is_not_there_is_an_error() {
        for (text, says) in [
            ("{a rows/by=press/error 2}", "there is no `by=press`"),
            ("{b seeds 2}", "`b` is not in `from`"),
            ("{a seeds 2}", "3 numbers"),
            ("{a rows/0/by 2}", "is no number"),
            ("{a seeds", "has no end"),
        ] {
            let error = format!("{:#}", filled(text, &values()).unwrap_err());
            assert!(error.contains(says), "{error}");
        }
    }
}
