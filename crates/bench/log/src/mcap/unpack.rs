//! Unpacks chunks that other writers have compressed.

use std::io::Read;

use lz4_flex::frame::FrameDecoder;
use ruzstd::decoding::StreamingDecoder;

/// Largest unpacked chunk, bytes.
const LARGEST_BYTES: u64 = 256 << 20;

/// The result.
pub(super) enum Unpacked {
    /// The stated number of bytes.
    Whole(Vec<u8>),
    Damaged,
    /// The compression is unknown.
    Unknown,
}

/// Unpacks `packed` to `length` bytes. `how` is the name of the compression in MCAP.
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

/// All bytes, if their number is as expected. Memory grows only with bytes that exist.
fn all(decoder: impl Read, length: u64) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let n_most = length.min(LARGEST_BYTES) + 1;
    decoder.take(n_most).read_to_end(&mut bytes).ok()?;
    (bytes.len() as u64 == length).then_some(bytes)
}
