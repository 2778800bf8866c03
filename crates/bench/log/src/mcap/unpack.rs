//! Chunks that other writers have compressed.

use std::io::Read;

use lz4_flex::frame::FrameDecoder;
use ruzstd::decoding::StreamingDecoder;

/// Largest chunk that is unpacked.
const LARGEST_BYTES: u64 = 256 << 20;

/// What came of it.
pub(super) enum Unpacked {
    /// As many bytes as it says.
    Whole(Vec<u8>),
    Damaged,
    /// It is compressed in a way that is not known.
    Unknown,
}

/// Unpacks what is compressed with `how`, the name that MCAP has for it, and has `length` bytes.
pub(super) fn unpack(how: &str, packed: &[u8], length: u64) -> Unpacked {
    let bytes = match how {
        "zstd" => StreamingDecoder::new(packed)
            .ok()
            .and_then(|decoder| all(decoder, length)),
        "lz4" => all(FrameDecoder::new(packed), length),
        _ => return Unpacked::Unknown,
    };
    bytes.map_or(Unpacked::Damaged, Unpacked::Whole)
}

/// All bytes, if they are as many as expected. Memory grows with those that come.
fn all(decoder: impl Read, length: u64) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let n_most = length.min(LARGEST_BYTES) + 1;
    decoder.take(n_most).read_to_end(&mut bytes).ok()?;
    (bytes.len() as u64 == length).then_some(bytes)
}
