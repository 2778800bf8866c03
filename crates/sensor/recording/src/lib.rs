//! Recordings of presses: their schema, Parquet files, and CSV files of other labs.
//!
//! A press is the unit of work: a named indenter, a pose with a time, and what was measured or simulated meanwhile.

mod append;
mod check;
mod error;
mod frames;
mod import;
mod lerobot;
mod missing;
mod press;
mod provenance;
mod store;

pub use error::RecordingError;
pub use frames::Frames;
pub use import::{
    Bag, BagTopic, FileSummary, Import, ImportSummary, ReadBag, guess_bag_import, guess_import,
};
pub use lerobot::LeRobotSummary;
pub use missing::null_as_nan;
pub use press::{Control, Press, Recording};
pub use provenance::Provenance;
pub use store::{Column, FrameTable, RecordingWriter, Stored, TaxelCell};
