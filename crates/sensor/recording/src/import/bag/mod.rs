//! Bags: recordings of several topics, each with its own clock. Another crate reads their files.

mod find;
mod resample;
mod table;

use std::collections::BTreeMap;
use std::path::Path;

pub(super) use find::{is_bag_column, is_numbered_alike, listed};
pub(super) use table::{Rows, table};

use crate::{Provenance, RecordingError};

/// Reads a bag: its topics, and of these the requested columns, each `/topic:field`. `None` if the
/// file is not a bag.
pub type ReadBag = fn(&Path, &[&str]) -> Option<Result<Bag, RecordingError>>;

/// The content of a bag.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bag {
    /// Its topics, in order of appearance.
    pub topics: Vec<BagTopic>,
    /// Provenance of the numbers, if the bag contains it.
    pub provenance: Option<Provenance>,
    /// Notes for a person on how it was read.
    pub notes: Vec<String>,
}

/// A topic with the requested numbers of its messages.
#[derive(Clone, Debug, PartialEq)]
pub struct BagTopic {
    /// Name, such as `/tactile`.
    pub name: String,
    /// Type of its messages, such as `sensor_msgs/msg/FluidPressure`.
    pub kind: String,
    /// Number of messages.
    pub messages: u64,
    /// Names of the numbers in its first message, or why its messages cannot be read.
    pub fields: Result<Vec<String>, String>,
    /// Numbers of the messages that were read, from 1; `[n_rows]`, empty if no column was
    /// requested.
    pub numbers: Vec<u64>,
    /// Times of recording, ns since 1970-01-01 UTC; `[n_rows]`.
    pub log_ns: Vec<i64>,
    /// Times of measurement in the headers, ns; `[n_rows]`, empty if messages have no such stamp.
    pub stamp_ns: Vec<i64>,
    /// The requested columns by field name, NaN if a message has no such field; `[n_rows]` each.
    /// Fields that no message has are left out.
    pub columns: BTreeMap<String, Vec<f64>>,
}
