//! A CSV file as columns of numbers, with the line of each row.

use std::collections::BTreeSet;
use std::path::Path;

use super::description::Description;
use crate::RecordingError;

/// The columns that were asked for, in the order asked.
pub(crate) struct Table {
    pub(crate) file: String,
    /// Line of each row, from 1; `[n_rows]`.
    pub(crate) lines: Vec<u64>,
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
}

impl Table {
    /// Reads the columns in `names` from a file; every cell must hold a finite number.
    pub(crate) fn read(
        path: &Path,
        description: &Description,
        names: &BTreeSet<&str>,
    ) -> Result<Self, RecordingError> {
        let file = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|source| RecordingError::read(path, source))?;
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(u8::try_from(description.delimiter).unwrap_or(b','))
            .has_headers(false)
            .trim(csv::Trim::All)
            .from_reader(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes));
        let mut records = reader.records();
        let header: Vec<String> = match &description.columns {
            Some(columns) => columns.clone(),
            None => match records.next() {
                Some(record) => record
                    .map_err(|e| line_error(&file, &e))?
                    .iter()
                    .map(str::to_owned)
                    .collect(),
                None => Vec::new(),
            },
        };
        let mut places = Vec::new();
        for &name in names {
            let place =
                header
                    .iter()
                    .position(|h| h == name)
                    .ok_or_else(|| RecordingError::MissingColumn {
                        file: file.clone(),
                        column: name.to_owned(),
                        found: if header.is_empty() {
                            "nothing".to_owned()
                        } else {
                            header.join(", ")
                        },
                    })?;
            places.push(place);
        }
        let mut table = Self {
            names: names.iter().map(|&name| name.to_owned()).collect(),
            columns: vec![Vec::new(); places.len()],
            lines: Vec::new(),
            file,
        };
        for record in records {
            let record = record.map_err(|e| line_error(&table.file, &e))?;
            let line = record.position().map_or(0, csv::Position::line);
            if record.len() != header.len() {
                let (expected, found) = (header.len(), record.len());
                let problem = format!("expected {expected} cells, found {found}");
                return Err(RecordingError::Line {
                    file: table.file,
                    line,
                    problem,
                });
            }
            table.lines.push(line);
            for (column, &place) in places.iter().enumerate() {
                let text = record.get(place).unwrap_or_default();
                match text.parse::<f64>() {
                    Ok(number) if number.is_finite() => table.columns[column].push(number),
                    _ => return Err(table.cell(line, column, text)),
                }
            }
        }
        Ok(table)
    }

    /// The column of that name, which must be one of those asked for; `[n_rows]`.
    pub(crate) fn column(&self, name: &str) -> &[f64] {
        self.names
            .iter()
            .position(|n| n == name)
            .map_or(&[], |place| &self.columns[place])
    }

    pub(crate) fn rows(&self) -> usize {
        self.lines.len()
    }

    fn cell(&self, line: u64, column: usize, text: &str) -> RecordingError {
        RecordingError::Cell {
            file: self.file.clone(),
            line,
            column: self.names[column].clone(),
            problem: if text.is_empty() {
                "is empty, expected a number".to_owned()
            } else {
                format!(
                    "is `{}`, expected a finite number",
                    text.chars().take(40).collect::<String>()
                )
            },
        }
    }
}

fn line_error(file: &str, error: &csv::Error) -> RecordingError {
    let line = error.position().map_or(0, csv::Position::line);
    let problem = match error.kind() {
        csv::ErrorKind::Utf8 { .. } => "is not UTF-8 text".to_owned(),
        csv::ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => format!("expected {expected_len} cells, found {len}"),
        _ => error.to_string(),
    };
    RecordingError::Line {
        file: file.to_owned(),
        line,
        problem,
    }
}
