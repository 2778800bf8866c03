//! The fields of an import description.

use std::collections::BTreeSet;

use serde::Deserialize;

use super::bag::is_bag_column;
use super::cell::Kind;
use super::unit::{Force, Length, Pressure, Temperature, Time, Unit};
use crate::Provenance;

/// An import description, with the overrides for a file applied. [`Import`](super::Import)
/// documents it for users.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Description {
    /// Name of the sensor's description.
    pub(crate) sensor: String,
    /// Provenance of the numbers: `real`, `emulated` or `simulated`.
    pub(crate) provenance: Provenance,
    /// Name of the indenter in the sensor's description.
    pub(crate) indenter: String,
    /// The separator of columns. Default: a comma.
    #[serde(default = "comma")]
    pub(crate) delimiter: char,
    /// Names of the columns of a file without a header line.
    pub(crate) columns: Option<Vec<String>>,
    /// Number of lines to skip before the header, or before the first row of a file without a
    /// header.
    #[serde(default)]
    pub(crate) skip_lines: u64,
    /// Lines that begin with this character are skipped, such as `#`.
    pub(crate) comment: Option<char>,
    /// The decimal separator of numbers: a point or a comma. Default: a point.
    #[serde(default = "point")]
    pub(crate) decimal: char,
    /// Texts for a missing reading, in addition to an empty cell, `NaN`, `NA`, `null`, `None` and
    /// `--` (upper and lower case are equal).
    #[serde(default)]
    pub(crate) missing: Vec<String>,
    /// Whether to leave out rows in which a number other than a reading is missing: a time, a
    /// position or a force.
    #[serde(default)]
    pub(crate) drop_incomplete_rows: bool,
    /// Number of rows to leave out at the start of each file.
    #[serde(default)]
    pub(crate) drop_rows: usize,
    /// Whether to leave out rows at the start that were read from a buffer: they follow each other
    /// in less than half the usual time step.
    #[serde(default)]
    pub(crate) drop_buffered: bool,
    /// Height of the unloaded gel above the board, mm.
    pub(crate) gel_top_mm: f64,
    /// The time column. If left out, rows have no time; messages of a bag have their own.
    pub(crate) time: Option<TimeColumn>,
    /// Position along the gel's x axis.
    #[serde(default)]
    pub(crate) x: Column<Length>,
    /// Position along the gel's y axis.
    #[serde(default)]
    pub(crate) y: Column<Length>,
    /// Height of the tip, on its own scale.
    pub(crate) z: Option<Column<Length>>,
    /// Rotation of the indenter. Default: upright.
    pub(crate) rotation: Option<Rotation>,
    /// Where that scale meets the gel.
    #[serde(default)]
    pub(crate) contact: Contact,
    /// Measured force of the indenter on the gel along -z.
    pub(crate) force: Option<Column<Force>>,
    /// Weight of a dead weight on the gel, N.
    pub(crate) weight_n: Option<f64>,
    /// Unit and range of all taxels' readings.
    pub(crate) readings: Readings,
    /// Unit and scale of all taxels' temperatures.
    #[serde(default)]
    pub(crate) temperatures: Temperatures,
    /// The column of each taxel.
    pub(crate) taxels: Vec<Taxel>,
    /// How a file is split into presses.
    pub(crate) presses: Split,
    /// How the zero of each taxel is found before each press.
    pub(crate) zero: Option<Zero>,
    /// How outliers of static readings are marked as not valid.
    pub(crate) outliers: Option<Outliers>,
    /// Other files of the same recording, each with its own clock.
    #[serde(default, rename = "join")]
    pub(crate) joins: Vec<Join>,
    /// Tables with `files`, a pattern of file names, and any of the fields above for these files.
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

/// A column and its conversion to mm, s or N: number × scale / divide_by × unit + offset.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, bound(deserialize = "U: Unit + Deserialize<'de>"))]
pub(crate) struct Column<U> {
    /// The column's name. If left out, the value is always the offset.
    pub(crate) column: Option<String>,
    /// The unit of its numbers: `mm`, `um`, `s`, `ms`, `N` and so on.
    #[serde(default)]
    pub(crate) unit: U,
    /// Factor of its numbers.
    #[serde(default = "one")]
    pub(crate) scale: f64,
    /// Divisor of its numbers.
    #[serde(default = "one")]
    pub(crate) divide_by: f64,
    /// Added value, in mm, s or N.
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

/// The time column.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TimeColumn {
    /// The column's name. If left out, the time is always the offset.
    pub(crate) column: Option<String>,
    /// Its unit: `s`, `ms`, `us` or `ns`; or `clock` for a time of day, such as 13:05:59.250, or a
    /// date and time, counted from the first row.
    #[serde(default)]
    pub(crate) unit: Time,
    /// Factor of its numbers.
    #[serde(default = "one")]
    pub(crate) scale: f64,
    /// Divisor of its numbers.
    #[serde(default = "one")]
    pub(crate) divide_by: f64,
    /// Added value, s.
    #[serde(default)]
    pub(crate) offset: f64,
    /// The number at which a counter rolls over to 0: 4294967296 for 32 bits. A time of day needs
    /// none.
    pub(crate) wraps_at: Option<f64>,
    /// How rows with the same time are read: as an `error` (default); as a burst to `spread` over
    /// the time since the burst before; or as measured at a rate: `{ rate_hz = 100.0 }`.
    #[serde(default)]
    pub(crate) repeated: Repeated,
}

impl TimeColumn {
    /// Its column, and how it is read.
    pub(crate) fn wanted(&self) -> Option<(&str, Kind)> {
        let is_clock = matches!(self.unit, Time::Clock);
        Some((
            self.column.as_deref()?,
            if is_clock { Kind::Clock } else { Kind::Number },
        ))
    }

    /// A count converted to a time, s.
    pub(crate) fn convert(&self, count: f64) -> f64 {
        self.convert_step(count) + self.offset
    }

    /// A difference of counts converted to a time, s.
    pub(crate) fn convert_step(&self, count: f64) -> f64 {
        count * self.scale / self.divide_by * self.unit.factor()
    }
}

/// Another file of the same recording, which has some of the columns.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Join {
    /// Its name, in the same folder. `{stem}` stands for the main file's name without its
    /// extension.
    pub(crate) file: String,
    /// The columns in this file. The main file does not have them.
    pub(crate) columns: Vec<String>,
    /// Its time column.
    pub(crate) time: TimeColumn,
    /// Its clock: the `same` as the main file's (default); `found` from the presses; or
    /// `{ offset_s = 1.12, rate = 1.0 }`, which converts its times to the main file's.
    #[serde(default)]
    pub(crate) clock: JoinClock,
    /// Largest time between one of its rows and one of the main file, s. Default 0.02.
    #[serde(default = "within_s")]
    pub(crate) within_s: f64,
    /// Names of its columns, if it has no header line.
    pub(crate) header: Option<Vec<String>>,
    /// As for the main file. Default: that of the main file.
    pub(crate) delimiter: Option<char>,
    /// As for the main file. Default: that of the main file.
    pub(crate) skip_lines: Option<u64>,
    /// As for the main file. Default: that of the main file.
    pub(crate) comment: Option<char>,
    /// As for the main file. Default: that of the main file.
    pub(crate) decimal: Option<char>,
}

fn within_s() -> f64 {
    0.02
}

/// How times of a joined file are converted to the main file's clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum JoinClock {
    /// They are the same.
    #[default]
    Same,
    /// By the clock with which the presses in both files coincide.
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
    /// The layout of its text.
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

/// How rows with the same time are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Repeated {
    /// As an error.
    #[default]
    Error,
    /// As rows that arrived together, and were measured in the time since the rows before.
    Spread,
    /// As rows that arrived together, and were measured at a rate; with `rate_hz`.
    #[serde(rename = "rate_hz")]
    RateHz(f64),
}

/// The columns of the indenter's rotation: a quaternion in the gel's frame.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rotation {
    /// Columns of x, y, z and w.
    pub(crate) columns: [String; 4],
    /// Their values for the upright indenter, as its description has it. Default [0, 0, 0, 1].
    #[serde(default = "identity")]
    pub(crate) upright: [f64; 4],
}

fn identity() -> [f64; 4] {
    [0.0, 0.0, 0.0, 1.0]
}

/// Where the scale of the z column meets the gel.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Contact {
    /// The z at which the tip touches the gel, on the z column's scale, mm.
    pub(crate) z_mm: f64,
    /// `up` (default), or `down` if the scale increases downwards.
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

/// Unit and range of all taxels' readings.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Readings {
    /// Unit of the readings: `Pa`, `hPa`, `kPa`, `mbar`, `bar` or `psi`; or `counts` of a
    /// converter.
    pub(crate) unit: Pressure,
    /// Pressure of one count, kPa.
    pub(crate) kpa_per_count: Option<f64>,
    /// Range of usable readings, in the file's own numbers.
    #[serde(default = "everything")]
    pub(crate) usable: [f64; 2],
}

fn everything() -> [f64; 2] {
    [f64::NEG_INFINITY, f64::INFINITY]
}

/// Unit and scale of all taxels' temperatures.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Temperatures {
    /// The column of a thermometer for all taxels without a temperature column of their own.
    pub(crate) column: Option<String>,
    /// Unit of all temperatures: `C`, `K` or `F`.
    pub(crate) unit: Temperature,
    /// Factor of their numbers.
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
    /// Factor of its numbers.
    #[serde(default = "one")]
    pub(crate) scale: f64,
    /// Added value, kPa.
    #[serde(default)]
    pub(crate) offset_kpa: f64,
    /// Time by which the taxel's reading lags behind the pose of the same row, s.
    #[serde(default)]
    pub(crate) lag_s: f64,
}

/// How a file is split into presses.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "split", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum Split {
    /// A press lasts from the tip's leaving its rest position, at `rest_mm` on the z column's
    /// scale, to its return.
    ReturnToRest {
        /// Rest position of the tip, mm on the z column's scale.
        #[serde(default)]
        rest_mm: f64,
        /// Largest distance from it at which the tip is still at rest, mm.
        #[serde(default = "tolerance_mm")]
        tolerance_mm: f64,
        /// Longest time at rest at the same location that is kept before and after the press, s.
        #[serde(default = "one")]
        keep_rest_s: f64,
    },
    /// A column has another number or text for each press. Rows without one belong to no press.
    Column {
        /// The column.
        column: String,
    },
    /// Every row is a static press of its own.
    Row,
    /// There are no presses: the log has only readings.
    None,
}

fn tolerance_mm() -> f64 {
    0.005
}

/// The frames before contact that give the zero of each press: the last `window_s` before the tip
/// is closer to the gel than `above_contact_mm`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Zero {
    /// Height above contact below which the tip is near, mm.
    pub(crate) above_contact_mm: f64,
    /// Duration before that, s.
    pub(crate) window_s: f64,
}

/// Outliers among static readings: those that differ from the median of their neighbours by more
/// than `jump` times the taxel's largest reading.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Outliers {
    /// Largest distance of neighbours, mm.
    pub(crate) within_mm: f64,
    /// Largest difference from the neighbours' median, as a fraction of the taxel's largest
    /// reading.
    pub(crate) jump: f64,
}

impl Readings {
    /// The file's unit of readings in kPa.
    pub(crate) fn kpa(&self) -> f64 {
        self.kpa_per_count.unwrap_or_else(|| self.unit.factor())
    }
}

impl Description {
    /// Whether its columns are those of a bag, whose messages have their own times.
    pub(crate) fn is_of_bag(&self) -> bool {
        self.taxels.iter().all(|taxel| is_bag_column(&taxel.column))
    }

    /// The column of a taxel's temperature.
    pub(crate) fn temperature_column(&self, taxel: usize) -> Option<&str> {
        let own = self.taxels[taxel].temperature.as_deref();
        own.or(self.temperatures.column.as_deref())
    }

    /// All columns that are read, and how.
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
