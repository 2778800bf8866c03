//! The container: MCAP. It is written without compression, and read with that of others.
//!
//! Source: the MCAP format specification, <https://mcap.dev/spec>. A file is `magic | records | magic`, a record its kind, its
//! length and its content. Messages stand in chunks, whose checksum tells whether they are whole.
//!
//! Writing here gives the same bytes for the same messages, and one call for each chunk, so that a file that was cut is whole
//! up to a chunk.

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
