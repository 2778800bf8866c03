//! Recordings in Parquet files: one row per frame, which pandas and the like open as they are.

mod column;
mod frames;
mod read;
mod schema;
mod seal;
mod write;

pub use frames::{FrameTable, TaxelCell};

#[cfg(test)]
mod tests;
