//! A file as columns of numbers, with the line of each row.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use csv::ByteRecord;
use rayon::prelude::*;

use super::cell::{Cells, Kind, Labels, Problem, cells};
use super::description::{Description, TimeColumn};
use super::header;
use super::text::Text;
use crate::RecordingError;

/// Number of rows that are split into cells before any is read. The cells of different columns are
/// then read in parallel.
const BATCH: usize = 4096;

/// The requested columns.
pub(crate) struct Table {
    pub(crate) file: String,
    /// What a row is: a line of a text, or a message of a bag.
    pub(crate) row_name: &'static str,
    /// Number of each row's line or message, from 1; `[n_rows]`.
    pub(crate) lines: Vec<u64>,
    /// The time column of the rows, if the description names none.
    pub(crate) clock: Option<TimeColumn>,
    columns: BTreeMap<(String, Kind), Vec<f64>>,
    /// Number of rows left out because a number other than a reading is missing.
    pub(crate) incomplete_rows: usize,
    /// Number of rows left out because another topic has no message near their time.
    pub(crate) rows_alone: usize,
    /// Columns, or topics of a bag, that were not read.
    pub(crate) unread: Vec<String>,
    /// Notes for people on how the file was read.
    pub(crate) notes: Vec<String>,
}

/// A column to read.
struct Wanted<'a> {
    name: &'a str,
    kind: Kind,
    place: usize,
    numbers: Vec<f64>,
    labels: Labels,
}

/// The rows read so far.
struct Rows<'a> {
    file: &'a str,
    lines: Vec<u64>,
    columns: Vec<Wanted<'a>>,
    cells: Cells<'a>,
}

/// Rows that were split into cells. The memory of records is reused.
#[derive(Default)]
struct Batch {
    lines: Vec<u64>,
    records: Vec<ByteRecord>,
}

impl Table {
    /// Columns of numbers. A row in which a number other than a reading is missing is left out if
    /// `drops_incomplete`, else it is an error.
    pub(crate) fn new(
        file: String,
        mut lines: Vec<u64>,
        mut columns: BTreeMap<(String, Kind), Vec<f64>>,
        drops_incomplete: bool,
    ) -> Result<Self, RecordingError> {
        let mut is_complete = vec![true; lines.len()];
        let needed = columns
            .iter()
            .filter(|((_, kind), _)| matches!(kind, Kind::Number | Kind::Clock));
        let mut first: Option<(usize, &str)> = None;
        for ((name, _), numbers) in needed {
            for (row, is_complete) in is_complete.iter_mut().enumerate() {
                if numbers[row].is_nan() {
                    *is_complete = false;
                    first = first.filter(|(other, _)| *other <= row).or(Some((row, name)));
                }
            }
        }
        if let Some((row, name)) = first.filter(|_| !drops_incomplete) {
            return Err(RecordingError::Cell {
                file,
                line: lines[row],
                column: name.to_owned(),
                problem:
                    "is missing, and only readings may be; `drop_incomplete_rows = true` leaves such rows out"
                        .to_owned(),
            });
        }
        let incomplete_rows = is_complete.iter().filter(|is_complete| !**is_complete).count();
        columns
            .values_mut()
            .for_each(|numbers| retain(numbers, &is_complete));
        retain(&mut lines, &is_complete);
        Ok(Self {
            file,
            row_name: "line",
            lines,
            clock: None,
            columns,
            incomplete_rows,
            rows_alone: 0,
            unread: Vec::new(),
            notes: Vec::new(),
        })
    }

    /// Reads columns of a text file with the described layout.
    pub(crate) fn read(
        path: &Path,
        description: &Description,
        wanted: &BTreeSet<(&str, Kind)>,
    ) -> Result<Self, RecordingError> {
        let file = path.display().to_string();
        let text = Text::read(path, description.skip_lines)?;
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(u8::try_from(description.delimiter).unwrap_or(b','))
            .comment(description.comment.and_then(|comment| u8::try_from(comment).ok()))
            .has_headers(false)
            .flexible(true)
            .from_reader(text.rest());
        let line_at = |at: Option<&csv::Position>| text.skipped_lines + at.map_or(0, csv::Position::line);
        let mut record = ByteRecord::new();
        let mut next = |record: &mut ByteRecord| {
            let found = reader.read_byte_record(record);
            found.map_err(|error| line_error(&file, line_at(error.position()), error.to_string()))
        };
        let blanks_separate = description.delimiter == ' ';
        let (header, header_line) = match &description.columns {
            Some(columns) => (columns.clone(), 1),
            None if next(&mut record)? => {
                let names = cells(&record, blanks_separate);
                let names = names.map(|name| String::from_utf8_lossy(name).into_owned());
                (names.collect(), line_at(record.position()))
            }
            None => (Vec::new(), 1),
        };
        let remedy = || header::remedy(text.rest(), text.skipped_lines, &header, description);
        let columns = wanted.iter().map(|&(name, kind)| {
            Ok(Wanted {
                name,
                kind,
                place: header::place(&file, header_line, &header, name, remedy)?,
                numbers: Vec::new(),
                labels: Labels::default(),
            })
        });
        let mut rows = Rows {
            file: &file,
            lines: Vec::new(),
            columns: columns.collect::<Result<_, RecordingError>>()?,
            cells: Cells::new(description.decimal, &description.missing),
        };
        let mut batch = Batch::default();
        // A line with another number of cells is an error, unless it is the last one and has no
        // end.
        let mut cut = None;
        let wrong = loop {
            let record = batch.next();
            match next(record) {
                Ok(true) => (),
                Ok(false) => break None,
                Err(error) => break Some(error),
            }
            if cut.is_some() {
                break cut.take();
            }
            let line = line_at(record.position());
            if blanks_separate {
                *record = cells(record, true).collect();
            }
            let n_cells = n_cells(record, header.len());
            if n_cells == header.len() {
                batch.keep(line);
                if batch.lines.len() == BATCH {
                    rows.take(&mut batch)?;
                }
            } else if record.iter().any(|cell| !cell.trim_ascii().is_empty()) {
                let problem = format!("expected {} cells, found {n_cells}", header.len());
                cut = Some(line_error(&file, line, problem));
            }
        };
        // An error in an earlier row is reported before one further down.
        rows.take(&mut batch)?;
        if let Some(error) = wrong {
            return Err(error);
        }
        let mut notes = text.notes.clone();
        match cut {
            Some(error) if !text.is_cut => return Err(error),
            Some(_) => {
                notes.push("ends within a line, as after a crash; that row is left out".to_owned());
            }
            None => (),
        }
        let is_read = |name: &&String| wanted.iter().any(|(wanted, _)| wanted == name);
        let unread = header.iter().filter(|name| !is_read(name) && !name.is_empty());
        let columns = rows.columns.into_iter();
        let columns = columns.map(|column| ((column.name.to_owned(), column.kind), column.numbers));
        let (lines, columns) = (rows.lines, columns.collect());
        let mut table = Self::new(file.clone(), lines, columns, description.drop_incomplete_rows)?;
        table.unread = unread.cloned().collect();
        table.notes = notes;
        Ok(table)
    }

    /// The requested column with this name and kind; `[n_rows]`.
    pub(crate) fn column(&self, name: &str, kind: Kind) -> &[f64] {
        self.columns
            .get(&(name.to_owned(), kind))
            .map_or(&[], Vec::as_slice)
    }

    /// Takes a column of readings out of the table. Only one taxel has it.
    pub(crate) fn take_readings(&mut self, name: &str) -> Vec<f64> {
        self.columns
            .remove(&(name.to_owned(), Kind::Reading))
            .unwrap_or_default()
    }

    /// Adds the columns of another table. `partners` has the row of the other table for each row;
    /// rows without one are left out.
    pub(crate) fn put_beside(&mut self, other: &Self, partners: &[Option<usize>]) {
        let is_kept: Vec<bool> = partners.iter().map(Option::is_some).collect();
        self.columns
            .values_mut()
            .for_each(|numbers| retain(numbers, &is_kept));
        retain(&mut self.lines, &is_kept);
        for (key, numbers) in &other.columns {
            if !self.columns.contains_key(key) {
                let beside = partners.iter().flatten().map(|row| numbers[*row]);
                self.columns.insert(key.clone(), beside.collect());
            }
        }
    }

    pub(crate) fn rows(&self) -> usize {
        self.lines.len()
    }
}

impl Batch {
    /// The next record to fill.
    fn next(&mut self) -> &mut ByteRecord {
        let place = self.lines.len();
        if place == self.records.len() {
            self.records.push(ByteRecord::new());
        }
        &mut self.records[place]
    }

    /// Keeps the record that was filled.
    fn keep(&mut self, line: u64) {
        self.lines.push(line);
    }

    fn records(&self) -> &[ByteRecord] {
        &self.records[..self.lines.len()]
    }
}

impl Rows<'_> {
    /// Reads the cells of all rows of a batch.
    fn take(&mut self, batch: &mut Batch) -> Result<(), RecordingError> {
        let (file, cells) = (self.file, &self.cells);
        let columns = self.columns.par_iter_mut();
        let wrong = columns.filter_map(|column| {
            let (row, problem) = column.take(batch.records(), cells).err()?;
            Some((row, column.name, problem))
        });
        // Reports the first error of a file; within a row, that of the first column.
        let wrong = wrong.collect::<Vec<_>>().into_iter().min_by_key(|(row, ..)| *row);
        if let Some((row, name, problem)) = wrong {
            return Err(RecordingError::Cell {
                file: file.to_owned(),
                line: batch.lines[row],
                column: name.to_owned(),
                problem,
            });
        }
        self.lines.append(&mut batch.lines);
        Ok(())
    }
}

impl Wanted<'_> {
    /// Reads its cells of these rows. An error says in which row, and why.
    fn take(&mut self, records: &[ByteRecord], cells: &Cells<'_>) -> Result<(), (usize, Problem)> {
        self.numbers.reserve(records.len());
        for (row, record) in records.iter().enumerate() {
            let cell = record[self.place].trim_ascii();
            let number = cells.read(cell, self.kind, &mut self.labels).map_err(|problem| {
                let is_header = cell == self.name.as_bytes();
                let started_again = || {
                    "occurs again: the log was started again in the same file; split it into two files"
                        .to_owned()
                };
                (row, if is_header { started_again() } else { problem })
            })?;
            self.numbers.push(number);
        }
        Ok(())
    }
}

/// Number of cells of a row. Surplus empty cells at the end do not count.
fn n_cells(record: &ByteRecord, n_columns: usize) -> usize {
    let mut n = record.len();
    while n > n_columns && record[n - 1].trim_ascii().is_empty() {
        n -= 1;
    }
    n
}

/// Keeps the rows that are marked.
pub(super) fn retain<T>(rows: &mut Vec<T>, is_kept: &[bool]) {
    let mut is_kept = is_kept.iter();
    rows.retain(|_| is_kept.next().is_some_and(|is_kept| *is_kept));
}

fn line_error(file: &str, line: u64, problem: String) -> RecordingError {
    RecordingError::Line {
        file: file.to_owned(),
        line,
        problem,
    }
}
