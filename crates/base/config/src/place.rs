//! From a field to its position in a text, and back.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

/// Line (from 1) of a byte of the text.
pub(crate) fn line_of(text: &str, byte: usize) -> usize {
    1 + text.bytes().take(byte).filter(|b| *b == b'\n').count()
}

/// The byte at which a field starts, or its nearest parent that exists; and whether the field
/// itself exists.
pub(crate) fn of_field(table: &DeTable<'_>, field: &str) -> (Option<usize>, bool) {
    let mut start = None;
    let mut inside: Option<&DeValue<'_>> = None;
    for step in field.split(['.', '[']).map(|step| step.trim_end_matches(']')) {
        let found = match inside {
            None => entry(table, step),
            Some(DeValue::Table(table)) => entry(table, step),
            Some(DeValue::Array(array)) => step
                .parse::<usize>()
                .ok()
                .and_then(|index| array.get(index))
                .map(|value| (value.span().start, value.get_ref())),
            Some(_) => None,
        };
        let Some((at, value)) = found else {
            return (start, false);
        };
        start = Some(at);
        inside = Some(value);
    }
    (start, inside.is_some())
}

fn entry<'a, 'i>(table: &'a DeTable<'i>, name: &str) -> Option<(usize, &'a DeValue<'i>)> {
    table
        .iter()
        .find(|(key, _)| key.get_ref() == name)
        .map(|(key, value)| (key.span().start, value.get_ref()))
}

/// The first number that is not finite: its span, field and text.
pub(crate) fn not_finite(table: &DeTable<'_>) -> Option<(Range<usize>, String, String)> {
    let mut found: Option<(Range<usize>, String, String)> = None;
    walk_table(table, "", &mut |span, field, value| {
        if let Some(DeValue::Float(number)) = value
            && !number.as_str().parse::<f64>().is_ok_and(f64::is_finite)
            && found.as_ref().is_none_or(|(first, ..)| span.start < first.start)
        {
            found = Some((span, field.to_owned(), number.as_str().to_owned()));
        }
    });
    found
}

/// Line and field of a serde error.
pub(crate) fn of_serde_error(text: &str, table: &DeTable<'_>, error: &toml::de::Error) -> (usize, String) {
    let span = error.span().unwrap_or(0..0);
    let mut closest: Option<(usize, String)> = None;
    walk_table(table, "", &mut |at, field, _| {
        let contains = at.start <= span.start && span.end <= at.end && !span.is_empty();
        if contains && closest.as_ref().is_none_or(|(length, _)| at.len() <= *length) {
            closest = Some((at.len(), field.to_owned()));
        }
    });
    let mut field = closest.map(|(_, field)| field).unwrap_or_default();
    // A missing field has no position. An unknown field inside of a tagged table has only the
    // position of the table. In both cases serde's message names the field.
    let names = |start: &str| {
        error
            .message()
            .strip_prefix(start)
            .and_then(|rest| rest.split('`').next())
    };
    if let Some(name) = names("missing field `").or_else(|| names("unknown field `"))
        && field.rsplit('.').next() != Some(name)
    {
        field = join(&field, name);
    }
    let start = of_field(table, &field).0.unwrap_or(span.start);
    (line_of(text, start), field)
}

/// Gets a span, a dotted path and the value; no value if the span is that of a key.
type Visit<'a> = dyn FnMut(Range<usize>, &str, Option<&DeValue<'_>>) + 'a;

/// Visits every key (without a value) and every value with its span and dotted path.
fn walk_table(table: &DeTable<'_>, path: &str, visit: &mut Visit<'_>) {
    for (key, value) in table {
        let path = join(path, key.get_ref());
        visit(key.span(), &path, None);
        walk_value(value.span(), value.get_ref(), &path, visit);
    }
}

fn walk_value(span: Range<usize>, value: &DeValue<'_>, path: &str, visit: &mut Visit<'_>) {
    visit(span, path, Some(value));
    match value {
        DeValue::Table(table) => walk_table(table, path, visit),
        DeValue::Array(array) => {
            for (index, element) in array.iter().enumerate() {
                walk_value(
                    element.span(),
                    element.get_ref(),
                    &format!("{path}[{index}]"),
                    visit,
                );
            }
        }
        _ => {}
    }
}

fn join(path: &str, name: &str) -> String {
    if path.is_empty() {
        name.to_owned()
    } else {
        format!("{path}.{name}")
    }
}
