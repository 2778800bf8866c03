//! What an import description says, field by field.

use std::collections::BTreeSet;

use serde::Deserialize;

use super::bag::is_bag_column;
use super::cell::Kind;
use super::unit::{Force, Length, Pressure, Temperature, Time, Unit};
use crate::Provenance;

/// One import description, after the overrides for a file were merged in. [`Import`](super::Import) documents it for users.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Description {
    /// Name of the sensor's description.
    pub(crate) sensor: String,
    /// Where the numbers come from: `real`, `emulated` or `simulated`.
    pub(crate) provenance: Provenance,
    /// Name of the indenter in the sensor's description.
    pub(crate) indenter: String,
    /// What stands between columns; a comma unless given.
    #[serde(default = "comma")]
    pub(crate) delimiter: char,
    /// Names of the columns of a file without a header line.
    pub(crate) columns: Option<Vec<String>>,
    /// Lines to leave out before the header, or before the first row of a file without one.
    #[serde(default)]
    pub(crate) skip_lines: u64,
    /// Lines that begin with this character are left out, such as `#`.
    pub(crate) comment: Option<char>,
    /// What stands before the fraction of a number: a point unless given, or a comma.
    #[serde(default = "point")]
    pub(crate) decimal: char,
    /// What stands in a cell for a reading that is missing, beside an empty cell, `NaN`, `NA`, `null`, `None` and `--`, in capitals or not.
    #[serde(default)]
    pub(crate) missing: Vec<String>,
    /// Whether to leave out rows in which anything else is missing: a time, a place or a force.
    #[serde(default)]
    pub(crate) drop_incomplete_rows: bool,
    /// Rows to leave out at the start of each file.
    #[serde(default)]
    pub(crate) drop_rows: usize,
    /// Whether to leave out rows at the start that come at less than half the usual time step, read from a buffer.
    #[serde(default)]
    pub(crate) drop_buffered: bool,
    /// Height of the unloaded gel above the board, mm.
    pub(crate) gel_top_mm: f64,
    /// Time; without it each row stands for itself, and messages of a bag have their own.
    pub(crate) time: Option<TimeColumn>,
    /// Place along the gel's x axis.
    #[serde(default)]
    pub(crate) x: Column<Length>,
    /// Place along the gel's y axis.
    #[serde(default)]
    pub(crate) y: Column<Length>,
    /// Height of the tip, on a scale of its own.
    pub(crate) z: Option<Column<Length>>,
    /// How the indenter is turned; upright unless given.
    pub(crate) rotation: Option<Rotation>,
    /// Where that scale meets the gel.
    #[serde(default)]
    pub(crate) contact: Contact,
    /// Measured force of the indenter on the gel along -z.
    pub(crate) force: Option<Column<Force>>,
    /// Weight of a dead weight that rests on the gel, N.
    pub(crate) weight_n: Option<f64>,
    /// What holds for the readings of all taxels.
    pub(crate) readings: Readings,
    /// What holds for the temperatures of all taxels.
    #[serde(default)]
    pub(crate) temperatures: Temperatures,
    /// Which column is which taxel.
    pub(crate) taxels: Vec<Taxel>,
    /// How presses are told apart.
    pub(crate) presses: Split,
    /// What the zero of each taxel is taken from, before each press.
    pub(crate) zero: Option<Zero>,
    /// Which static readings are marked as not valid.
    pub(crate) outliers: Option<Outliers>,
    /// Other files of the same recording, each on a clock of its own.
    #[serde(default, rename = "join")]
    pub(crate) joins: Vec<Join>,
    /// Tables with `files`, a pattern of names, and any of the fields above for these files.
    #[serde(default, rename = "override")]
    pub(crate) overrides: Vec<toml::Table>,
}

fn comma() -> char {
    ','
}

fn point() -> char {
    '.'
}

fn one() -> f64 {
    1.0
}

/// A column and the line from its numbers to the project's unit: number × scale / divide_by × unit + offset.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, bound(deserialize = "U: Unit + Deserialize<'de>"))]
pub(crate) struct Column<U> {
    /// Without a column the value is the offset, everywhere.
    pub(crate) column: Option<String>,
    /// Its unit: `mm`, `um`, `s`, `ms`, `N` and the like.
    #[serde(default)]
    pub(crate) unit: U,
    /// What its numbers are multiplied with.
    #[serde(default = "one")]
    pub(crate) scale: f64,
    /// What they are divided by.
    #[serde(default = "one")]
    pub(crate) divide_by: f64,
    /// What is added, in mm, s or N.
    #[serde(default)]
    pub(crate) offset: f64,
}

impl<U: Unit> Default for Column<U> {
    fn default() -> Self {
        Self {
            column: None,
            unit: U::default(),
            scale: 1.0,
            divide_by: 1.0,
            offset: 0.0,
        }
    }
}

impl<U: Unit> Column<U> {
    pub(crate) fn convert(&self, number: f64) -> f64 {
        number * self.scale / self.divide_by * self.unit.factor() + self.offset
    }
}

/// The column of the time.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TimeColumn {
    /// Without a column the time is the offset, everywhere.
    pub(crate) column: Option<String>,
    /// Its unit: `s`, `ms`, `us`, `ns`; or `clock` for the time of day, such as 13:05:59.250, or a date and time, counted from the first row.
    #[serde(default)]
    pub(crate) unit: Time,
    /// What its numbers are multiplied with.
    #[serde(default = "one")]
    pub(crate) scale: f64,
    /// What they are divided by.
    #[serde(default = "one")]
    pub(crate) divide_by: f64,
    /// What is added, s.
    #[serde(default)]
    pub(crate) offset: f64,
    /// The number that would follow the largest one of a counter that then begins again at 0: 4294967296 for 32 bits. Clocks of a day need none.
    pub(crate) wraps_at: Option<f64>,
    /// What several rows with the same time are: an `error` unless given; written in one burst, so that they are to be `spread` over the time since the burst before;
    /// or measured at a rate: `{ rate_hz = 100.0 }`.
    #[serde(default)]
    pub(crate) repeated: Repeated,
}

impl TimeColumn {
    /// Its column, and as what it is read.
    pub(crate) fn wanted(&self) -> Option<(&str, Kind)> {
        let is_clock = matches!(self.unit, Time::Clock);
        Some((
            self.column.as_deref()?,
            if is_clock { Kind::Clock } else { Kind::Number },
        ))
    }

    /// A count as a time, s.
    pub(crate) fn convert(&self, count: f64) -> f64 {
        self.convert_step(count) + self.offset
    }

    /// A difference of counts as a time, s.
    pub(crate) fn convert_step(&self, count: f64) -> f64 {
        count * self.scale / self.divide_by * self.unit.factor()
    }
}

/// Another file of the same recording, with some of the columns.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Join {
    /// Its name, in the same folder; `{stem}` stands for the main file's name without its ending.
    pub(crate) file: String,
    /// The columns that are its, which the main file does not have.
    pub(crate) columns: Vec<String>,
    /// Its time.
    pub(crate) time: TimeColumn,
    /// Its clock: the `same` as the main file's unless given; `found` by the presses; or what makes main times of its own: `{ offset_s = 1.12, rate = 1.0 }`.
    #[serde(default)]
    pub(crate) clock: JoinClock,
    /// How far in time a row of it may be from one of the main file, s; 0.02 unless given.
    #[serde(default = "within_s")]
    pub(crate) within_s: f64,
    /// Names of its columns, if it has no header line.
    pub(crate) header: Option<Vec<String>>,
    /// As for the main file, whose is meant unless given.
    pub(crate) delimiter: Option<char>,
    /// As for the main file, whose is meant unless given.
    pub(crate) skip_lines: Option<u64>,
    /// As for the main file, whose is meant unless given.
    pub(crate) comment: Option<char>,
    /// As for the main file, whose is meant unless given.
    pub(crate) decimal: Option<char>,
}

fn within_s() -> f64 {
    0.02
}

/// What the times of a joined file are on the main file's clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum JoinClock {
    /// The same.
    #[default]
    Same,
    /// Whatever makes the presses in both the same.
    Found,
    /// `offset_s + rate · time`.
    #[serde(untagged)]
    Given {
        offset_s: f64,
        #[serde(default = "one")]
        rate: f64,
    },
}

impl Join {
    /// How its text is written.
    pub(crate) fn layout(&self, main: &Description) -> Description {
        Description {
            columns: self.header.clone(),
            delimiter: self.delimiter.unwrap_or(main.delimiter),
            skip_lines: self.skip_lines.unwrap_or(main.skip_lines),
            comment: self.comment.or(main.comment),
            decimal: self.decimal.unwrap_or(main.decimal),
            ..main.clone()
        }
    }
}

/// What several rows with the same time are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Repeated {
    /// An error.
    #[default]
    Error,
    /// Rows that arrived together, and were measured in the time since those before.
    Spread,
    /// Rows that arrived together, and were measured at a rate: with `rate_hz`.
    #[serde(rename = "rate_hz")]
    RateHz(f64),
}

/// The columns of the indenter's rotation, a quaternion in the gel's frame.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rotation {
    /// Columns of x, y, z and w.
    pub(crate) columns: [String; 4],
    /// What they say where the indenter is upright, as its description has it; [0, 0, 0, 1] unless given.
    #[serde(default = "identity")]
    pub(crate) upright: [f64; 4],
}

fn identity() -> [f64; 4] {
    [0.0, 0.0, 0.0, 1.0]
}

/// Where the z column's scale meets the gel.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Contact {
    /// The z at which the tip touches the gel, on the z column's own scale, mm.
    pub(crate) z_mm: f64,
    /// `up` unless given; `down` if the scale grows downwards.
    #[serde(default)]
    pub(crate) z_points: Direction,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Direction {
    #[default]
    Up,
    Down,
}

/// What holds for the readings of all taxels.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Readings {
    /// Unit of the readings: `Pa`, `hPa`, `kPa`, `mbar`, `bar`, `psi`; or `counts` of a converter.
    pub(crate) unit: Pressure,
    /// Pressure of one count, kPa.
    pub(crate) kpa_per_count: Option<f64>,
    /// Readings outside, in the file's own numbers, cannot be used.
    #[serde(default = "everything")]
    pub(crate) usable: [f64; 2],
}

fn everything() -> [f64; 2] {
    [f64::NEG_INFINITY, f64::INFINITY]
}

/// What holds for the temperatures of all taxels.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Temperatures {
    /// The column of a thermometer that stands for all taxels that have no column of their own.
    pub(crate) column: Option<String>,
    /// Unit of all temperatures: `C`, `K` or `F`.
    pub(crate) unit: Temperature,
    /// What their numbers are multiplied with.
    pub(crate) scale: f64,
}

impl Default for Temperatures {
    fn default() -> Self {
        Self {
            column: None,
            unit: Temperature::default(),
            scale: 1.0,
        }
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Taxel {
    /// Its name in the sensor's description.
    pub(crate) name: String,
    /// Its column.
    pub(crate) column: String,
    /// The column of its temperature.
    pub(crate) temperature: Option<String>,
    /// What its numbers are multiplied with.
    #[serde(default = "one")]
    pub(crate) scale: f64,
    /// What is added, kPa.
    #[serde(default)]
    pub(crate) offset_kpa: f64,
    /// How much later than the pose of the same row the taxel is to be read, s.
    #[serde(default)]
    pub(crate) lag_s: f64,
}

/// How presses are told apart.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "split", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum Split {
    /// The tip leaves its rest, at `rest_mm` of the z column's scale, and returns to it.
    ReturnToRest {
        /// Where the tip rests, mm on the z column's scale.
        #[serde(default)]
        rest_mm: f64,
        /// How far from there it still rests, mm.
        #[serde(default = "tolerance_mm")]
        tolerance_mm: f64,
        /// Most time at rest, in the same place, that is kept before and after, s.
        #[serde(default = "one")]
        keep_rest_s: f64,
    },
    /// A column has another number or text for each press. Rows without one belong to none.
    Column {
        /// The column.
        column: String,
    },
    /// Every row is a press of its own, static.
    Row,
    /// There are none: the log has readings alone.
    None,
}

fn tolerance_mm() -> f64 {
    0.005
}

/// Which frames before the contact are the zero of each press: the last `window_s` before the tip comes closer to the gel
/// than `above_contact_mm`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Zero {
    /// Height above the contact from which on the tip is near, mm.
    pub(crate) above_contact_mm: f64,
    /// How long before that, s.
    pub(crate) window_s: f64,
}

/// Which static readings are outliers: farther from the median of the neighbours than `jump` of the taxel's largest reading.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Outliers {
    /// How far neighbours are, mm.
    pub(crate) within_mm: f64,
    /// How far a reading may be from the neighbours' median, over the taxel's largest.
    pub(crate) jump: f64,
}

impl Readings {
    /// One of the file's numbers, kPa.
    pub(crate) fn kpa(&self) -> f64 {
        self.kpa_per_count.unwrap_or_else(|| self.unit.factor())
    }
}

impl Description {
    /// Whether its columns are those of a bag, whose messages have times of their own.
    pub(crate) fn is_of_bag(&self) -> bool {
        self.taxels.iter().all(|taxel| is_bag_column(&taxel.column))
    }

    /// The column of a taxel's temperature.
    pub(crate) fn temperature_column(&self, taxel: usize) -> Option<&str> {
        let own = self.taxels[taxel].temperature.as_deref();
        own.or(self.temperatures.column.as_deref())
    }

    /// All columns that are read, and as what.
    pub(crate) fn wanted(&self) -> BTreeSet<(&str, Kind)> {
        let readings = self
            .taxels
            .iter()
            .map(|taxel| (taxel.column.as_str(), Kind::Reading));
        let mut wanted: BTreeSet<(&str, Kind)> = readings.collect();
        let temperatures = (0..self.taxels.len()).filter_map(|taxel| self.temperature_column(taxel));
        wanted.extend(temperatures.map(|name| (name, Kind::Reading)));
        wanted.extend(self.time.as_ref().and_then(TimeColumn::wanted));
        let places = [self.x.column.as_deref(), self.y.column.as_deref()];
        let height = self.z.as_ref().and_then(|z| z.column.as_deref());
        let force = self.force.as_ref().and_then(|force| force.column.as_deref());
        let turns = self
            .rotation
            .iter()
            .flat_map(|rotation| &rotation.columns)
            .map(String::as_str);
        let numbers = places.into_iter().chain([height, force]).flatten().chain(turns);
        wanted.extend(numbers.map(|name| (name, Kind::Number)));
        if let Split::Column { column } = &self.presses {
            wanted.insert((column, Kind::Label));
        }
        wanted
    }
}
