//! Guesses how the lines of a file are split into cells, from the form of most lines.

use super::column::Column;
use crate::import::cell::{Cells, Kind, Labels, cells};

/// Number of lines that are examined.
const LINES: usize = 5000;

/// Smallest fraction of numbers among the cells of a row.
const NUMERIC: f64 = 0.6;

/// How the lines of a file are split into cells, and which line names the columns.
pub(super) struct Layout {
    pub(super) delimiter: u8,
    pub(super) has_decimal_comma: bool,
    pub(super) comment: Option<u8>,
    /// Lines before the header.
    pub(super) skip_lines: usize,
    /// `None` if the first row already has numbers.
    pub(super) header: Option<Vec<String>>,
    n_cells: usize,
}

impl Layout {
    /// The layout with the most cells in rows of numbers. `None` if there are no such rows.
    pub(super) fn find(text: &[u8]) -> Option<Self> {
        let lines: Vec<&[u8]> = text.split(|&byte| byte == b'\n').take(LINES).collect();
        let comment = [b'#', b'%'].into_iter().find(|mark| {
            let marked = lines.iter().filter(|line| line.first() == Some(mark));
            marked.count() > 0
        });
        let is_row = |line: &&[u8]| {
            !line.trim_ascii().is_empty() && (comment.is_none() || line.first() != comment.as_ref())
        };
        let candidates = [
            (b',', false),
            (b';', true),
            (b';', false),
            (b'\t', true),
            (b'\t', false),
            (b' ', false),
        ];
        let layouts = candidates
            .into_iter()
            .filter_map(|(delimiter, has_decimal_comma)| {
                let rows: Vec<Vec<String>> = lines
                    .iter()
                    .filter(|line| is_row(line))
                    .map(|line| split(line, delimiter))
                    .collect();
                // The middle row has the shape of most rows.
                let n_cells = rows.get(rows.len() / 2)?.len();
                let numeric = |row: &&Vec<String>| row.len() == n_cells && is_numeric(row, has_decimal_comma);
                let n_numeric = rows.iter().filter(numeric).count();
                (n_cells > 1 && 2 * n_numeric > rows.len()).then_some((
                    n_cells * n_numeric,
                    delimiter,
                    has_decimal_comma,
                    n_cells,
                ))
            });
        // Of equal layouts the first: a comma is more likely a separator than a decimal comma.
        let best = layouts.reduce(|best, next| if next.0 > best.0 { next } else { best })?;
        let (_, delimiter, may_have_decimal_comma, n_cells) = best;
        let has_numbers = |line: &[u8]| {
            let row = split(line, delimiter);
            line.first() != comment.as_ref()
                && row.len() == n_cells
                && is_numeric(&row, may_have_decimal_comma)
        };
        let first_row = lines.iter().position(|line| has_numbers(line))?;
        // Without any comma among the numbers, they have decimal points.
        let has_comma = |line: &[u8]| has_numbers(line) && line.contains(&b',');
        let has_decimal_comma = may_have_decimal_comma && lines.iter().any(|line| has_comma(line));
        let header_line = (0..first_row)
            .rev()
            .find(|&line| split(lines[line], delimiter).len() == n_cells);
        let header = header_line.map(|line| split(lines[line], delimiter));
        // A header behind a comment mark cannot be read as a header.
        let is_marked = header_line.is_some_and(|line| lines[line].first() == comment.as_ref());
        let named = header.map(|mut names| {
            if is_marked && let Some(first) = names.first_mut() {
                *first = first.trim_start_matches(['#', '%', ' ']).to_owned();
            }
            names
        });
        Some(Self {
            delimiter,
            has_decimal_comma,
            comment,
            skip_lines: match header_line {
                // Empty lines and comment lines are skipped anyway.
                Some(line) if !is_marked => lines[..line].iter().rposition(is_row).map_or(0, |last| last + 1),
                _ => 0,
            },
            header: named.filter(|_| !is_marked),
            n_cells,
        })
    }

    /// The columns, with the numbers of the first rows.
    pub(super) fn columns(&self, text: &[u8]) -> Vec<Column> {
        let (reading, mut labels) = (
            Cells::new(if self.has_decimal_comma { ',' } else { '.' }, &[]),
            Labels::default(),
        );
        let names = self
            .header
            .clone()
            .unwrap_or_else(|| (1..=self.n_cells).map(|cell| format!("c{cell}")).collect());
        let mut columns: Vec<Column> = names.into_iter().map(Column::named).collect();
        for line in text.split(|&byte| byte == b'\n').take(LINES) {
            let row = split(line, self.delimiter);
            if row.len() != self.n_cells
                || !is_numeric(&row, self.has_decimal_comma)
                || line.first() == self.comment.as_ref()
            {
                continue;
            }
            for (column, cell) in columns.iter_mut().zip(&row) {
                match reading.read(cell.as_bytes(), Kind::Reading, &mut labels) {
                    Ok(number) => column.numbers.push(number),
                    Err(_) if reading.read(cell.as_bytes(), Kind::Clock, &mut labels).is_ok() => {
                        column.is_clock = true
                    }
                    Err(_) => column.is_text = true,
                }
            }
        }
        columns
    }
}

fn split(line: &[u8], delimiter: u8) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .has_headers(false)
        .from_reader(line);
    let mut record = csv::ByteRecord::new();
    if !reader.read_byte_record(&mut record).unwrap_or(false) {
        return Vec::new();
    }
    let mut row: Vec<String> = cells(&record, delimiter == b' ')
        .map(|cell| String::from_utf8_lossy(cell).into_owned())
        .collect();
    while row.len() > 1 && row.last().is_some_and(String::is_empty) {
        row.pop();
    }
    row
}

fn is_numeric(row: &[String], has_decimal_comma: bool) -> bool {
    let is_number = |cell: &&String| {
        let cell = if has_decimal_comma {
            cell.replace(',', ".")
        } else {
            (*cell).clone()
        };
        cell.parse::<f64>().is_ok()
    };
    row.iter().filter(is_number).count() as f64 >= NUMERIC * row.len() as f64
}
