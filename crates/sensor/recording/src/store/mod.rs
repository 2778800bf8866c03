//! Recordings in Parquet files: one row per frame, which pandas and the like open as they are.

mod column;
mod frames;
mod read;
mod schema;
mod seal;
mod table;
mod write;

pub use frames::{FrameTable, TaxelCell};
pub use table::Column;
pub use write::RecordingWriter;

#[cfg(test)]
mod tests;
