//! Messages that wait to be written together.

use super::record::{Records, op};

/// A chunk that is being filled: its messages, and the offsets of each channel's messages.
#[derive(Debug)]
pub(crate) struct Chunk {
    messages: Records,
    /// Time and offset of each message, by channel.
    index: Vec<Vec<(u64, u64)>>,
    /// Times of the first and the last message, ns.
    span_ns: Option<(u64, u64)>,
}

impl Chunk {
    pub(crate) fn new(channels: usize) -> Self {
        Self {
            messages: Records::default(),
            index: vec![Vec::new(); channels],
            span_ns: None,
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.span_ns.is_none()
    }

    pub(crate) fn len_bytes(&self) -> usize {
        self.messages.bytes.len()
    }

    /// Times of the first and the last message, ns.
    pub(crate) fn span_ns(&self) -> Option<(u64, u64)> {
        self.span_ns
    }

    /// Number of messages of each channel, by index.
    pub(crate) fn counts(&self) -> impl Iterator<Item = u64> {
        self.index.iter().map(|entries| entries.len() as u64)
    }

    /// Adds a message of the channel with an index. The number of the channel in the file is the
    /// index plus one.
    pub(crate) fn add(
        &mut self,
        channel: usize,
        sequence: u32,
        time_ns: u64,
        put: impl FnOnce(&mut Vec<u8>),
    ) {
        let place = self.len_bytes() as u64;
        self.index[channel].push((time_ns, place));
        self.messages.put(op::MESSAGE, |r| {
            r.u16(number(channel));
            r.u32(sequence);
            r.u64(time_ns);
            r.u64(time_ns);
            put(&mut r.bytes);
        });
        let (earliest, latest) = self.span_ns.unwrap_or((time_ns, time_ns));
        self.span_ns = Some((earliest.min(time_ns), latest.max(time_ns)));
    }

    /// Appends the chunk and its index to `out`, which begins at `offset` of the file, and the
    /// entry of the chunk in the summary to `found`. Empties the chunk.
    pub(crate) fn finish(&mut self, offset: u64, out: &mut Records, found: &mut Records) {
        let (earliest_ns, latest_ns) = self.span_ns.unwrap_or_default();
        let start = out.bytes.len();
        let content = &self.messages.bytes;
        out.put(op::CHUNK, |r| {
            r.u64(earliest_ns);
            r.u64(latest_ns);
            r.u64(content.len() as u64);
            r.u32(crc32fast::hash(content));
            r.string(""); // no compression
            r.u64(content.len() as u64);
            r.bytes.extend(content);
        });
        let chunk_bytes = out.bytes.len() - start;
        let mut places = Vec::new();
        for (channel, entries) in self
            .index
            .iter()
            .enumerate()
            .filter(|(_, entries)| !entries.is_empty())
        {
            places.push((number(channel), offset + (out.bytes.len() - start) as u64));
            out.put(op::MESSAGE_INDEX, |r| {
                r.u16(number(channel));
                r.sized(|r| {
                    for (time_ns, place) in entries {
                        r.u64(*time_ns);
                        r.u64(*place);
                    }
                });
            });
        }
        found.put(op::CHUNK_INDEX, |r| {
            r.u64(earliest_ns);
            r.u64(latest_ns);
            r.u64(offset);
            r.u64(chunk_bytes as u64);
            r.sized(|r| {
                for (channel, place) in &places {
                    r.u16(*channel);
                    r.u64(*place);
                }
            });
            r.u64((out.bytes.len() - start - chunk_bytes) as u64);
            r.string("");
            r.u64(content.len() as u64);
            r.u64(content.len() as u64);
        });
        self.messages.bytes.clear();
        self.index.iter_mut().for_each(Vec::clear);
        self.span_ns = None;
    }
}

/// Number of the channel or schema with an index, counted from 1, because 0 means none. The check
/// of a description bounds the index.
pub(crate) fn number(place: usize) -> u16 {
    u16::try_from(place + 1).unwrap_or(u16::MAX)
}
