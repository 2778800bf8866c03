//! The content of a cell: a number, a missing reading, a time, or a label.

use std::collections::HashMap;

use chrono::{DateTime, NaiveDateTime, NaiveTime, Timelike};

/// How a column is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// A finite number. If it is missing, the row is left out or it is an error.
    Number,
    /// A finite number; NaN if missing.
    Reading,
    /// A time of day, or date and time, in s. A time of day wraps at midnight.
    Clock,
    /// Any text: equal texts become equal numbers. An empty text is NaN.
    Label,
}

/// Seconds of a day.
pub(crate) const DAY_S: f64 = 86_400.0;

/// Words for a missing reading, in lower case.
const MISSING: [&str; 8] = ["", "nan", "-nan", "na", "n/a", "null", "none", "--"];

/// Formats of date and time that loggers and spreadsheets write. A fraction may follow after a
/// point or a comma.
const DATES: [&str; 6] = [
    "%Y-%m-%dT%H:%M:%S%.f",
    "%Y-%m-%d %H:%M:%S%.f",
    "%Y/%m/%d %H:%M:%S%.f",
    "%Y%m%d_%H%M%S%.f",
    "%d.%m.%Y %H:%M:%S%.f",
    "%Y-%m-%d_%H-%M-%S%.f",
];

/// How cells are read.
pub(crate) struct Cells<'a> {
    has_decimal_comma: bool,
    missing: Vec<&'a str>,
    /// Numbers that stand for a missing reading, such as -999.
    missing_numbers: Vec<f64>,
}

/// The labels of a column, each with a number.
#[derive(Default)]
pub(crate) struct Labels(HashMap<String, u32>);

/// Why a cell cannot be read; it follows the cell's name: "is `x`, expected a number".
pub(crate) type Problem = String;

impl<'a> Cells<'a> {
    /// `decimal` is the decimal separator; `missing` are words for missing readings.
    pub(crate) fn new(decimal: char, missing: &'a [String]) -> Self {
        let missing: Vec<&str> = missing.iter().map(String::as_str).collect();
        Self {
            has_decimal_comma: decimal == ',',
            missing_numbers: missing.iter().filter_map(|word| word.parse().ok()).collect(),
            missing,
        }
    }

    /// The number of a cell; NaN if missing. `labels` are those of its column.
    pub(crate) fn read(&self, cell: &[u8], kind: Kind, labels: &mut Labels) -> Result<f64, Problem> {
        let text = std::str::from_utf8(cell).unwrap_or("\u{fffd}");
        match kind {
            Kind::Number | Kind::Reading => self.number(text),
            Kind::Clock if self.is_missing(text) => Ok(f64::NAN),
            Kind::Clock => {
                clock_s(text).ok_or_else(|| format!("{}, expected a time, such as 13:05:59.250", is(text)))
            }
            Kind::Label if text.is_empty() => Ok(f64::NAN),
            Kind::Label => Ok(f64::from(labels.number(text))),
        }
    }

    fn number(&self, text: &str) -> Result<f64, Problem> {
        let number = if self.has_decimal_comma {
            text.replace(',', ".").parse::<f64>()
        } else {
            text.parse()
        };
        match number {
            Ok(number) if self.missing_numbers.contains(&number) => Ok(f64::NAN),
            Ok(number) if number.is_finite() => Ok(number),
            _ if self.is_missing(text) => Ok(f64::NAN),
            Ok(_) => Err(format!(
                "{}, expected a finite number; if that stands for a missing reading, name it in `missing`",
                is(text)
            )),
            Err(_) if is_number_with_comma(text) => Err(format!(
                "{}, expected a number; a decimal comma is read with `decimal = \",\"`",
                is(text)
            )),
            Err(_) if clock_s(text).is_some() => Err(format!(
                "{}, expected a number; a clock's time is read with `unit = \"clock\"`",
                is(text)
            )),
            Err(_) => Err(format!(
                "{}, expected a number; if that stands for a missing reading, name it in `missing`",
                is(text)
            )),
        }
    }

    fn is_missing(&self, text: &str) -> bool {
        self.missing.contains(&text) || MISSING.iter().any(|word| text.eq_ignore_ascii_case(word))
    }
}

impl Labels {
    /// The number of a label. Texts of the same number are the same label.
    fn number(&mut self, text: &str) -> u32 {
        let name = text
            .parse::<f64>()
            .map_or_else(|_| text.to_owned(), |number| number.to_string());
        let next = self.0.len() as u32;
        *self.0.entry(name).or_insert(next)
    }
}

/// The cells of a line without blanks around them. If blanks separate, any number of them does.
pub(super) fn cells(record: &csv::ByteRecord, blanks_separate: bool) -> impl Iterator<Item = &[u8]> {
    let cells = record.iter().map(<[u8]>::trim_ascii);
    cells.filter(move |cell| !(blanks_separate && cell.is_empty()))
}

fn is(text: &str) -> String {
    format!("is `{}`", text.chars().take(40).collect::<String>())
}

fn is_number_with_comma(text: &str) -> bool {
    text.matches(',').count() == 1 && text.replace(',', ".").parse::<f64>().is_ok()
}

/// Seconds since midnight of a time of day, or since 1970 of a date and time.
fn clock_s(text: &str) -> Option<f64> {
    let text = text.replace(',', ".");
    let seconds =
        |time: NaiveTime| f64::from(time.num_seconds_from_midnight()) + fraction_s(time.nanosecond());
    if let Ok(time) = NaiveTime::parse_from_str(&text, "%H:%M:%S%.f") {
        return Some(seconds(time));
    }
    let date = DateTime::parse_from_rfc3339(&text)
        .map(|date| date.naive_utc())
        .ok();
    let date = date.or_else(|| {
        DATES
            .iter()
            .find_map(|form| NaiveDateTime::parse_from_str(&text, form).ok())
    })?;
    Some(date.and_utc().timestamp() as f64 + fraction_s(date.nanosecond()))
}

fn fraction_s(nanoseconds: u32) -> f64 {
    f64::from(nanoseconds) * 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_are_read_as_loggers_write_them() {
        for (text, seconds) in [
            ("13:05:59.250", 47_159.25),
            ("13:05:59,250", 47_159.25),
            ("00:00:01", 1.0),
            ("1970-01-02T00:00:00.5Z", 86_400.5),
            ("1970-01-02T01:00:00+01:00", 86_400.0),
            ("1970-01-02 00:00:00.125", 86_400.125),
            ("02.01.1970 00:00:00", 86_400.0),
            ("19700102_000000.5", 86_400.5),
        ] {
            assert_eq!(clock_s(text), Some(seconds), "{text}");
        }
        for text in ["", "1.5", "25:00:00", "13:05", "soon"] {
            assert_eq!(clock_s(text), None, "{text}");
        }
    }
}
