//! Finds a file's columns, and what may help if they are not found.

use super::cell::cells;
use super::description::Description;
use crate::RecordingError;

/// Number of lines in which a header is searched.
const LINES: usize = 100;

/// Separators that files are known to have.
const DELIMITERS: [(u8, &str); 4] = [(b',', ","), (b';', ";"), (b'\t', "\\t"), (b' ', " ")];

/// The position of a column, which must exist exactly once.
pub(super) fn place(
    file: &str,
    line: u64,
    header: &[String],
    name: &str,
    remedy: impl FnOnce() -> Option<String>,
) -> Result<usize, RecordingError> {
    let mut places = header
        .iter()
        .enumerate()
        .filter(|(_, other)| *other == name)
        .map(|(place, _)| place);
    let Some(place) = places.next() else {
        let found = if header.is_empty() {
            "nothing".to_owned()
        } else {
            header.join(", ")
        };
        let found = remedy().map_or(found.clone(), |remedy| format!("{found}; {remedy}"));
        return Err(RecordingError::MissingColumn {
            file: file.to_owned(),
            line,
            column: name.to_owned(),
            found,
        });
    };
    match places.next() {
        None => Ok(place),
        Some(other) => Err(RecordingError::Line {
            file: file.to_owned(),
            line,
            problem: format!(
                "two columns have the name `{name}`, the {} and the {}; give them names of their own, or name all columns with `columns` and leave this line out with `skip_lines`",
                ordinal(place + 1),
                ordinal(other + 1)
            ),
        }),
    }
}

/// The setting with which the columns are found: another separator, or lines to skip before the
/// header.
pub(super) fn remedy(
    text: &[u8],
    skipped_lines: u64,
    header: &[String],
    description: &Description,
) -> Option<String> {
    let wanted = description.wanted();
    let has_all = |names: &[String]| {
        wanted
            .iter()
            .all(|(name, _)| names.iter().any(|other| other == name))
    };
    let lines = text.split(|&byte| byte == b'\n').take(LINES);
    for (index, line) in lines.enumerate() {
        for (delimiter, shown) in DELIMITERS {
            let mut reader = csv::ReaderBuilder::new()
                .delimiter(delimiter)
                .has_headers(false)
                .from_reader(line);
            let Some(Ok(record)) = reader.byte_records().next() else {
                continue;
            };
            let names =
                cells(&record, delimiter == b' ').map(|name| String::from_utf8_lossy(name).into_owned());
            if !has_all(&names.collect::<Vec<_>>()) {
                continue;
            }
            let mut settings = Vec::new();
            if description.delimiter != char::from(delimiter) {
                settings.push(format!("`delimiter = \"{shown}\"`"));
            }
            if index > 0 {
                settings.push(format!("`skip_lines = {}`", skipped_lines + index as u64));
            }
            let line = skipped_lines + index as u64 + 1;
            return Some(format!(
                "line {line} has all columns: set {}",
                settings.join(" and ")
            ));
        }
    }
    let is_number = |name: &String| name.parse::<f64>().is_ok();
    (!header.is_empty() && header.iter().all(is_number))
        .then(|| "these are numbers: name the columns with `columns = [...]`".to_owned())
}

fn ordinal(number: usize) -> String {
    let end = match (number % 10, number % 100) {
        (1, tens) if tens != 11 => "st",
        (2, tens) if tens != 12 => "nd",
        (3, tens) if tens != 13 => "rd",
        _ => "th",
    };
    format!("{number}{end}")
}
