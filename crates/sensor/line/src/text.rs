//! Numbers from a line of text or JSON.

use serde_json::Value;

use crate::description::{Description, Form};
use crate::field::Meaning;
use crate::heard::Passed;
use crate::row::Row;

/// Reads the numbers of a line; `None` for a missing reading.
pub(crate) fn read(description: &Description, line: &str, row: &mut Row) -> Result<(), Passed> {
    let (line, comment) = (line.trim(), &description.text.comment);
    if description.form == Form::Text && !comment.is_empty() && line.starts_with(comment) {
        return Err(Passed::Comment); // comments have no checksum
    }
    let line = whole(description, line)?;
    match description.form {
        Form::Json => read_object(description, line, row),
        _ => read_numbers(description, line, row),
    }
}

/// A line without its checksum, if the checksum is correct.
fn whole<'a>(description: &Description, line: &'a str) -> Result<&'a str, Passed> {
    let Some(checksum) = description.text.checksum else {
        return Ok(line);
    };
    let Some((line, digits)) = line.rsplit_once('*') else {
        return Err(Passed::of_nothing(line));
    };
    let said = u32::from_str_radix(digits.trim(), 16);
    match said == Ok(checksum.of(line.as_bytes())) {
        true => Ok(line),
        false => Err(Passed::Checksum),
    }
}

fn read_numbers(description: &Description, line: &str, row: &mut Row) -> Result<(), Passed> {
    let text = &description.text;
    let Some(numbers) = line.strip_prefix(text.prefix.as_str()) else {
        return Err(Passed::of_nothing(line));
    };
    let stripped: String;
    let numbers = match text.strip.is_empty() {
        true => numbers,
        false => {
            stripped = numbers.chars().filter(|c| !text.strip.contains(*c)).collect();
            &stripped
        }
    };
    let mut cells = cells(numbers.trim(), &text.separator);
    for field in &description.fields {
        for _ in 0..field.repeats {
            let cell = cells.next().ok_or_else(|| Passed::of_nothing(line))?;
            row.push(field.meaning, number(description, cell, line)?);
        }
    }
    // A separator at the end adds no number.
    match cells.all(str::is_empty) {
        true => Ok(()),
        false => Err(Passed::of_nothing(line)),
    }
}

fn cells<'a>(line: &'a str, separator: &'a str) -> Box<dyn Iterator<Item = &'a str> + 'a> {
    match separator {
        "blank" => Box::new(line.split_ascii_whitespace()),
        _ => Box::new(line.split(separator).map(str::trim)),
    }
}

fn number(description: &Description, cell: &str, line: &str) -> Result<Option<f64>, Passed> {
    let is_missing = |word: &String| word.eq_ignore_ascii_case(cell);
    if cell.is_empty() || cell.eq_ignore_ascii_case("nan") || description.text.missing.iter().any(is_missing)
    {
        return Ok(None);
    }
    let number: f64 = cell.parse().map_err(|_| Passed::of_nothing(line))?;
    Ok(Some(number).filter(|number| number.is_finite()))
}

fn read_object(description: &Description, line: &str, row: &mut Row) -> Result<(), Passed> {
    if !line.starts_with('{') {
        return Err(Passed::of_nothing(line));
    }
    let object: Value = serde_json::from_str(line).map_err(|_| Passed::Torn)?;
    for (key, field) in &description.keys {
        let value = object.get(key);
        let list = match value {
            Some(Value::Array(list)) => list.as_slice(),
            Some(value) => std::slice::from_ref(value),
            None if field.meaning == Meaning::Pressure || field.meaning == Meaning::Temperature => {
                &[Value::Null; 1]
            }
            None => return Err(Passed::Torn),
        };
        let is_left_out = matches!(list, [Value::Null]);
        if list.len() != field.repeats && !is_left_out {
            return Err(Passed::Torn);
        }
        for index in 0..field.repeats {
            let number = match list.get(index) {
                None | Some(Value::Null) => None,
                Some(Value::String(word)) => number(description, word, line)?,
                Some(value) => Some(value.as_f64().ok_or(Passed::Torn)?),
            };
            row.push(field.meaning, number.filter(|number| number.is_finite()));
        }
    }
    Ok(())
}
