//! A bag as one table: the messages of one topic are the rows, and other topics are interpolated at
//! their times.

use std::collections::{BTreeMap, BTreeSet};

use super::find::{LOG_TIME, STAMP, find};
use super::resample::Between;
use super::{Bag, BagTopic};
use crate::RecordingError;
use crate::import::cell::Kind;
use crate::import::description::{Description, Repeated, Rotation, TimeColumn};
use crate::import::table::{Table, retain};
use crate::import::unit::Time;

/// Which messages of a bag become rows, and how.
pub(in crate::import) struct Rows<'a> {
    /// The time column, if one is named: the messages of its topic are the rows.
    pub(in crate::import) time: Option<&'a str>,
    /// Otherwise: a column of the topic whose messages are the rows.
    pub(in crate::import) first: &'a str,
    /// A quaternion, whose sign may change as it turns.
    pub(in crate::import) rotation: Option<&'a Rotation>,
    /// The usable range of readings.
    pub(in crate::import) usable: [f64; 2],
    pub(in crate::import) drops_incomplete: bool,
}

impl<'a> Rows<'a> {
    /// The rows for a description, with the time column of the main file or of a joined one.
    pub(in crate::import) fn of(
        description: &'a Description,
        time: Option<&'a TimeColumn>,
        wanted: &BTreeSet<(&str, Kind)>,
    ) -> Self {
        let mut taxels = description.taxels.iter();
        let first = taxels.find(|taxel| wanted.contains(&(&*taxel.column, Kind::Reading)));
        Self {
            time: time.and_then(|time| time.column.as_deref()),
            first: first.map_or("", |taxel| &taxel.column),
            rotation: description.rotation.as_ref(),
            usable: description.readings.usable,
            drops_incomplete: description.drop_incomplete_rows,
        }
    }
}

/// The messages that are the rows, and their times.
struct Clock<'a> {
    topic: &'a BagTopic,
    /// Whether the times of all topics are those of the recorder.
    is_of_log: bool,
    field: &'static str,
    rows_ns: &'a [i64],
}

/// The rows' positions between the messages of another topic.
struct Beside {
    between: Between,
    /// Whether rows without this topic are left out.
    is_needed: bool,
    /// Whether a reading is missing in rows without this topic.
    is_read: bool,
}

/// The wanted columns at the times of the rows. If no time column is named, [`Table::clock`] is the
/// time column to take.
pub(in crate::import) fn table(
    file: &str,
    mut bag: Bag,
    wanted: &BTreeSet<(&str, Kind)>,
    rows: &Rows,
) -> Result<Table, RecordingError> {
    rows.rotation
        .into_iter()
        .for_each(|rotation| smooth(&mut bag, rotation));
    let clock = Clock::new(&bag, file, rows)?;
    let mut topics: BTreeMap<&str, Beside> = BTreeMap::new();
    let mut columns = BTreeMap::new();
    for &(name, kind) in wanted {
        let (topic, field) = find(&bag, file, name)?;
        if kind == Kind::Clock {
            let problem = "holds numbers, and `unit = \"clock\"` is for text".to_owned();
            return Err(wrong_column(file, name, problem));
        }
        let mut numbers = values(topic, field);
        if !std::ptr::eq(topic, clock.topic) {
            if !topics.contains_key(&*topic.name) {
                topics.insert(&topic.name, Beside::new(topic, &clock, file)?);
            }
            if let Some(beside) = topics.get_mut(&*topic.name) {
                numbers = beside.at_rows(&numbers, kind, rows.usable);
            }
        }
        columns.insert((name.to_owned(), kind), numbers);
    }
    let time = rows.time.is_none().then(|| clock.since_first_row());
    if let Some(time) = &time {
        let name = time.column.clone().unwrap_or_default();
        columns.insert((name, Kind::Number), seconds(clock.rows_ns));
    }
    let mut notes = bag.notes.clone();
    let mut is_kept = vec![true; clock.rows_ns.len()];
    for (name, beside) in &topics {
        notes.extend(beside.check(name, &clock, file)?);
        for (row, is_kept) in is_kept.iter_mut().enumerate() {
            *is_kept &= !beside.is_needed || beside.between.is_known(row);
        }
    }
    let mut numbers = clock.topic.numbers.clone();
    retain(&mut numbers, &is_kept);
    columns.values_mut().for_each(|column| retain(column, &is_kept));
    let mut table = Table::new(file.to_owned(), numbers, columns, rows.drops_incomplete)?;
    table.row_name = "message";
    table.rows_alone = is_kept.iter().filter(|is_kept| !**is_kept).count();
    table.unread = unread(&bag, wanted);
    table.notes = notes;
    table.clock = time;
    Ok(table)
}

impl<'a> Clock<'a> {
    fn new(bag: &'a Bag, file: &str, rows: &Rows) -> Result<Self, RecordingError> {
        let (topic, field) = find(bag, file, rows.time.unwrap_or(rows.first))?;
        let is_of_log = field == LOG_TIME;
        let (field, rows_ns) = times_ns(topic, is_of_log);
        Ok(Self {
            topic,
            is_of_log,
            field,
            rows_ns,
        })
    }

    /// Times that count from the first row.
    fn since_first_row(&self) -> TimeColumn {
        let first_s = self.rows_ns.first().map_or(0.0, |&first_ns| in_seconds(first_ns));
        TimeColumn {
            column: Some(format!("{}:{}", self.topic.name, self.field)),
            unit: Time::S,
            scale: 1.0,
            divide_by: 1.0,
            offset: -first_s,
            wraps_at: None,
            repeated: Repeated::Error,
        }
    }

    /// What helps if topics have different clocks.
    fn remedy(&self) -> String {
        format!(
            "`time = {{ column = \"{}:{LOG_TIME}\" }}` uses the times at which messages were recorded",
            self.topic.name
        )
    }
}

impl Beside {
    fn new(topic: &BagTopic, clock: &Clock, file: &str) -> Result<Self, RecordingError> {
        let (field, times_ns) = times_ns(topic, clock.is_of_log);
        if let Some(at) = times_ns.windows(2).position(|step| step[1] < step[0]) {
            return Err(RecordingError::Cell {
                file: file.to_owned(),
                line: topic.numbers[at + 1],
                column: format!("{}:{field}", topic.name),
                problem: format!(
                    "is {} s after {} s, expected times not to fall; {}",
                    in_seconds(times_ns[at + 1]),
                    in_seconds(times_ns[at]),
                    clock.remedy()
                ),
            });
        }
        Ok(Self {
            between: Between::new(times_ns, clock.rows_ns),
            is_needed: false,
            is_read: false,
        })
    }

    /// A column of the topic at the times of the rows.
    fn at_rows(&mut self, numbers: &[f64], kind: Kind, usable: [f64; 2]) -> Vec<f64> {
        match kind {
            // A label is valid until the next one.
            Kind::Label => self.between.latest(numbers),
            Kind::Reading => {
                self.is_read = true;
                self.between.line_within(numbers, usable)
            }
            Kind::Number | Kind::Clock => {
                self.is_needed = true;
                self.between.line(numbers)
            }
        }
    }

    /// A note or an error about rows without data of this topic.
    fn check(&self, name: &str, clock: &Clock, file: &str) -> Result<Option<String>, RecordingError> {
        let n_unknown = self.between.n_unknown();
        if n_unknown == 0 || !(self.is_needed || self.is_read) {
            return Ok(None);
        }
        let main = &clock.topic.name;
        let within_ms = self.between.within_ns as f64 * 1e-6;
        if n_unknown == clock.rows_ns.len() {
            return Err(RecordingError::Bag {
                file: file.to_owned(),
                problem: format!(
                    "no message of {main} lies between two of {name} that are at most {within_ms:.0} ms apart; if their clocks differ, {}",
                    clock.remedy()
                ),
            });
        }
        let so = if self.is_needed {
            "are left out"
        } else {
            "have no reading of it"
        };
        Ok(Some(format!(
            "{n_unknown} messages of {main} do not lie between two of {name} that are at most {within_ms:.0} ms apart, and {so}"
        )))
    }
}

/// The times at which messages of a topic were measured, or else recorded, and the field that has
/// them.
fn times_ns(topic: &BagTopic, is_of_log: bool) -> (&'static str, &[i64]) {
    // Drivers that do not fill in their headers leave zeros there.
    let is_stamped = topic.stamp_ns.iter().any(|&stamp_ns| stamp_ns != 0);
    if is_stamped && !is_of_log {
        (STAMP, &topic.stamp_ns)
    } else {
        (LOG_TIME, &topic.log_ns)
    }
}

/// The numbers of a field.
fn values(topic: &BagTopic, field: &str) -> Vec<f64> {
    match field {
        STAMP => seconds(&topic.stamp_ns),
        LOG_TIME => seconds(&topic.log_ns),
        _ => topic.columns.get(field).cloned().unwrap_or_default(),
    }
}

fn seconds(times_ns: &[i64]) -> Vec<f64> {
    times_ns.iter().copied().map(in_seconds).collect()
}

fn in_seconds(time_ns: i64) -> f64 {
    time_ns as f64 * 1e-9
}

/// Sets the signs of quaternions so that neighbours are close. Both signs are the same rotation,
/// but interpolation needs equal ones.
fn smooth(bag: &mut Bag, rotation: &Rotation) {
    let fields = rotation.columns.each_ref().map(|column| column.split_once(':'));
    let [Some((name, x)), Some((_, y)), Some((_, z)), Some((_, w))] = fields else {
        return;
    };
    for topic in bag.topics.iter_mut().filter(|topic| topic.name == name) {
        let mut before = [0.0; 4];
        for row in 0..topic.numbers.len() {
            let of = |field: &str| topic.columns.get(field).map_or(0.0, |numbers| numbers[row]);
            let mut turn = [x, y, z, w].map(of);
            let along: f64 = before.iter().zip(turn).map(|(one, other)| one * other).sum();
            if along < 0.0 {
                turn = turn.map(|number| -number);
                for (field, number) in [x, y, z, w].into_iter().zip(turn) {
                    if let Some(numbers) = topic.columns.get_mut(field) {
                        numbers[row] = number;
                    }
                }
            }
            before = turn;
        }
    }
}

/// Topics that no column was read from.
fn unread(bag: &Bag, wanted: &BTreeSet<(&str, Kind)>) -> Vec<String> {
    let topics = wanted.iter().filter_map(|(column, _)| column.split_once(':'));
    let read: BTreeSet<&str> = topics.map(|(topic, _)| topic).collect();
    let names = bag.topics.iter().map(|topic| topic.name.clone());
    names.filter(|name| !read.contains(&**name)).collect()
}

fn wrong_column(file: &str, column: &str, problem: String) -> RecordingError {
    RecordingError::BagColumn {
        file: file.to_owned(),
        column: column.to_owned(),
        problem,
    }
}
