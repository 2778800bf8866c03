//! Bags: recordings of several topics, each with a clock of its own. What reads their files stands in another crate.

mod find;
mod resample;
mod table;

use std::collections::BTreeMap;
use std::path::Path;

pub(super) use find::{is_bag_column, is_numbered_alike, listed};
pub(super) use table::{Rows, table};

use crate::{Provenance, RecordingError};

/// Reads a bag: its topics, and of these the columns that are asked for, `/topic:field` each. None if the file is no bag.
pub type ReadBag = fn(&Path, &[&str]) -> Option<Result<Bag, RecordingError>>;

/// What was read of a bag.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bag {
    /// Its topics, in the order in which they came.
    pub topics: Vec<BagTopic>,
    /// Where its numbers come from, if it says so itself.
    pub provenance: Option<Provenance>,
    /// What a person should know of how it was read.
    pub notes: Vec<String>,
}

/// A topic, and of its messages what was asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct BagTopic {
    /// Such as `/tactile`.
    pub name: String,
    /// Type of its messages, such as `sensor_msgs/msg/FluidPressure`.
    pub kind: String,
    /// How many messages it has.
    pub messages: u64,
    /// Names of the numbers in its first message; or why its messages cannot be read.
    pub fields: Result<Vec<String>, String>,
    /// Numbers of the messages that were read, from 1; `[n_rows]`, empty where nothing was asked for.
    pub numbers: Vec<u64>,
    /// When they were recorded, ns since 1970-01-01 UTC; `[n_rows]`.
    pub log_ns: Vec<i64>,
    /// When they were measured, as their headers say, ns; `[n_rows]`, empty where messages have no such stamp.
    pub stamp_ns: Vec<i64>,
    /// What was asked for, by the field as it was written there, NaN where a message has none; `[n_rows]` each. Fields that no message has are not there.
    pub columns: BTreeMap<String, Vec<f64>>,
}
