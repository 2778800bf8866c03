//! A file as columns of numbers, with the place of each row.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use csv::ByteRecord;
use rayon::prelude::*;

use super::cell::{Cells, Kind, Labels, Problem, cells};
use super::description::{Description, TimeColumn};
use super::header;
use super::text::Text;
use crate::RecordingError;

/// Rows that are split into cells before any is read: the cells of different columns are then read at once.
const BATCH: usize = 4096;

/// The columns that were asked for, each read as what it was asked for as.
pub(crate) struct Table {
    pub(crate) file: String,
    /// What a row is: a line of a text, or a message of a bag.
    pub(crate) row_name: &'static str,
    /// Number of each row's line or message, from 1; `[n_rows]`.
    pub(crate) lines: Vec<u64>,
    /// The time of the rows where the description names none.
    pub(crate) clock: Option<TimeColumn>,
    columns: BTreeMap<(String, Kind), Vec<f64>>,
    /// Rows that were left out because a number is missing that is no reading.
    pub(crate) incomplete_rows: usize,
    /// Rows that were left out because another topic has nothing at their time.
    pub(crate) rows_alone: usize,
    /// Columns, or topics of a bag, that nothing was read of.
    pub(crate) unread: Vec<String>,
    /// What a person should know of how the file was read.
    pub(crate) notes: Vec<String>,
}

/// A column to be read.
struct Wanted<'a> {
    name: &'a str,
    kind: Kind,
    place: usize,
    numbers: Vec<f64>,
    labels: Labels,
}

/// The rows that were read so far.
struct Rows<'a> {
    file: &'a str,
    lines: Vec<u64>,
    columns: Vec<Wanted<'a>>,
    cells: Cells<'a>,
}

/// Rows that were split into cells. Records that were read once lend their memory to later ones.
#[derive(Default)]
struct Batch {
    lines: Vec<u64>,
    records: Vec<ByteRecord>,
}

impl Table {
    /// Columns of numbers, without the rows in which one is missing that is no reading: these are left out if `drops_incomplete` says so, and else an error.
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

    /// Reads columns of a file whose text is as described.
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
        // A line of another number of cells is an error, unless it turns out to be the last one and has no end.
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
        // What is wrong in a row comes before what is wrong further down.
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

    /// The column of that name, which must be one of those asked for, read as that; `[n_rows]`.
    pub(crate) fn column(&self, name: &str, kind: Kind) -> &[f64] {
        self.columns
            .get(&(name.to_owned(), kind))
            .map_or(&[], Vec::as_slice)
    }

    /// Hands out a column of readings, which no other taxel has.
    pub(crate) fn take_readings(&mut self, name: &str) -> Vec<f64> {
        self.columns
            .remove(&(name.to_owned(), Kind::Reading))
            .unwrap_or_default()
    }

    /// Puts the columns of another table beside these rows, by the row of it that each one's partner is; rows without one are left out.
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
    /// A record to be filled.
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
    /// Takes the cells of all rows of a batch.
    fn take(&mut self, batch: &mut Batch) -> Result<(), RecordingError> {
        let (file, cells) = (self.file, &self.cells);
        let columns = self.columns.par_iter_mut();
        let wrong = columns.filter_map(|column| {
            let (row, problem) = column.take(batch.records(), cells).err()?;
            Some((row, column.name, problem))
        });
        // The first of a file is said, and in a row the first in order of columns.
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
    /// Takes its cells of rows, or says in which one it can't, and why.
    fn take(&mut self, records: &[ByteRecord], cells: &Cells<'_>) -> Result<(), (usize, Problem)> {
        self.numbers.reserve(records.len());
        for (row, record) in records.iter().enumerate() {
            let cell = record[self.place].trim_ascii();
            let number = cells.read(cell, self.kind, &mut self.labels).map_err(|problem| {
                let is_header = cell == self.name.as_bytes();
                let started_again = || {
                    "is there again: the log was started again in the same file; make it two files".to_owned()
                };
                (row, if is_header { started_again() } else { problem })
            })?;
            self.numbers.push(number);
        }
        Ok(())
    }
}

/// The cells of a row of a table of so many columns: empty ones at the end that are too many do not count.
fn n_cells(record: &ByteRecord, n_columns: usize) -> usize {
    let mut n = record.len();
    while n > n_columns && record[n - 1].trim_ascii().is_empty() {
        n -= 1;
    }
    n
}

/// Keeps the rows that are to be kept.
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
