//! Variants of a file in which one number is changed, for tests of ranges.

use toml::Value;

/// For each number of the text, in the order of the file: its dotted path, and the text in which
/// this number is replaced by `number`.
///
/// # Panics
/// The text is not TOML.
#[must_use]
pub fn with_each_number(text: &str, number: f64) -> Vec<(String, String)> {
    let whole = Value::Table(text.parse().expect("a TOML text"));
    let mut paths = Vec::new();
    walk("", &whole, &mut paths);
    let change = |path: String| {
        let mut changed = whole.clone();
        let steps = path.split(['.', '[']).map(|step| step.trim_end_matches(']'));
        let place = steps.fold(&mut changed, |inside, step| match inside {
            Value::Array(values) => &mut values[step.parse::<usize>().expect("an index")],
            table => &mut table[step],
        });
        let is_whole = place.is_integer() && number.fract() == 0.0 && number.abs() < 1e15;
        *place = if is_whole {
            Value::Integer(number as i64)
        } else {
            Value::Float(number)
        };
        let text = toml::to_string(&changed).expect("what was read can be written");
        (path, text)
    };
    paths.into_iter().map(change).collect()
}

fn walk(path: &str, value: &Value, paths: &mut Vec<String>) {
    match value {
        Value::Table(table) => {
            for (name, value) in table {
                let dot = if path.is_empty() { "" } else { "." };
                walk(&format!("{path}{dot}{name}"), value, paths);
            }
        }
        Value::Array(values) => {
            for (index, value) in values.iter().enumerate() {
                walk(&format!("{path}[{index}]"), value, paths);
            }
        }
        Value::Float(_) | Value::Integer(_) => paths.push(path.to_owned()),
        _ => {}
    }
}
