//! What an import description says, field by field.

use std::collections::BTreeSet;

use serde::Deserialize;

use super::unit::{Force, Length, Pressure, Time, Unit};
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
    /// Rows to leave out at the start of each file.
    #[serde(default)]
    pub(crate) drop_rows: usize,
    /// Whether to leave out rows at the start that come at less than half the usual time step, read from a buffer.
    #[serde(default)]
    pub(crate) drop_buffered: bool,
    /// Height of the unloaded gel above the board, mm.
    pub(crate) gel_top_mm: f64,
    /// Time, in `s` or `ms`; without it each row stands for itself.
    pub(crate) time: Option<Column<Time>>,
    /// Place along the gel's x axis.
    #[serde(default)]
    pub(crate) x: Column<Length>,
    /// Place along the gel's y axis.
    #[serde(default)]
    pub(crate) y: Column<Length>,
    /// Height of the tip, on a scale of its own.
    pub(crate) z: Option<Column<Length>>,
    /// Where that scale meets the gel.
    #[serde(default)]
    pub(crate) contact: Contact,
    /// Measured force of the indenter on the gel along -z.
    pub(crate) force: Option<Column<Force>>,
    /// Weight of a dead weight that rests on the gel, N.
    pub(crate) weight_n: Option<f64>,
    /// What holds for the readings of all taxels.
    pub(crate) readings: Readings,
    /// Which column is which taxel.
    pub(crate) taxels: Vec<Taxel>,
    /// How presses are told apart.
    pub(crate) presses: Split,
    /// What the zero of each taxel is taken from, before each press.
    pub(crate) zero: Option<Zero>,
    /// Which static readings are marked as not valid.
    pub(crate) outliers: Option<Outliers>,
    /// Tables with `files`, a pattern of names, and any of the fields above for these files.
    #[serde(default, rename = "override")]
    pub(crate) overrides: Vec<toml::Table>,
}

fn comma() -> char {
    ','
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
    /// Unit of the readings: `Pa`, `kPa` and the like.
    pub(crate) unit: Pressure,
    /// Readings outside, in the file's own numbers, cannot be used.
    #[serde(default = "everything")]
    pub(crate) usable: [f64; 2],
}

fn everything() -> [f64; 2] {
    [f64::NEG_INFINITY, f64::INFINITY]
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Taxel {
    /// Its name in the sensor's description.
    pub(crate) name: String,
    /// Its column.
    pub(crate) column: String,
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
    /// A column has another number for each press.
    Column {
        /// The column.
        column: String,
    },
    /// Every row is a press of its own, static.
    Row,
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

impl Description {
    /// All columns that are read.
    pub(crate) fn column_names(&self) -> BTreeSet<&str> {
        let mut names: BTreeSet<&str> = self.taxels.iter().map(|taxel| taxel.column.as_str()).collect();
        names.extend(self.time.as_ref().and_then(|time| time.column.as_deref()));
        names.extend(self.x.column.as_deref());
        names.extend(self.y.column.as_deref());
        names.extend(self.z.as_ref().and_then(|z| z.column.as_deref()));
        names.extend(self.force.as_ref().and_then(|force| force.column.as_deref()));
        if let Split::Column { column } = &self.presses {
            names.insert(column);
        }
        names
    }
}
