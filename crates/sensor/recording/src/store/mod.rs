//! Recordings in Parquet files: one row per frame. pandas and similar programs can open them
//! directly.

mod column;
mod file;
mod frames;
mod read;
mod schema;
mod seal;
mod stored;
mod table;
mod write;

pub use frames::{FrameTable, TaxelCell};
pub use stored::Stored;
pub use table::Column;
pub use write::RecordingWriter;

#[cfg(test)]
mod tests;
