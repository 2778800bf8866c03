//! Recordings in Parquet files: one row per frame, which pandas and the like open as they are.

mod column;
mod read;
mod schema;
mod seal;
mod write;

#[cfg(test)]
mod tests;
