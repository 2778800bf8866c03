//! The container MCAP. It is written without compression, and is read with the compression of other
//! writers.
//!
//! Source: the MCAP format specification, <https://mcap.dev/spec>. A file is
//! `magic | records | magic`. A record is its kind, its length and its content. Messages are in
//! chunks, whose checksum shows whether they are complete.
//!
//! This writer gives the same bytes for the same messages, and makes one write call for each chunk.
//! A file that was cut is therefore complete up to a chunk.

mod chunk;
mod record;
mod scan;
mod source;
mod summary;
mod take;
mod unpack;

pub(crate) use chunk::{Chunk, number};
pub(crate) use record::{Records, op};
pub(crate) use scan::{Found, Scanner, Schema, Statistics};
pub(crate) use summary::Summary;

/// First and last bytes of a file.
pub(crate) const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";
