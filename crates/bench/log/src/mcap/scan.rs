//! Reads records from first to last, as far as the bytes go.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::ops::Range;
use std::sync::Arc;

use crc32fast::Hasher;

use super::source::Source;
use super::take::Take;
use super::unpack::{Unpacked, unpack};
use super::{MAGIC, op};

/// Largest record that is read. Longer ones count as damage. Chunks of common writers have a few
/// MB.
const LARGEST_RECORD_BYTES: u64 = 64 << 20;
const FRAMING_BYTES: usize = 9;

/// Number of bytes that are checked before all of a record is read: the header of a chunk, with the
/// name of a compression.
const HEADER_BYTES: usize = 44;

/// Something found in a file.
#[derive(Debug)]
pub(crate) enum Found<'a> {
    /// A channel, the encoding of its messages, and their schema.
    Channel {
        id: u16,
        topic: String,
        encoding: String,
        schema: Arc<Schema>,
    },
    /// Texts about the file.
    Metadata {
        name: String,
        map: BTreeMap<String, String>,
    },
    /// A message of a channel, with its number in the channel.
    Message {
        channel: u16,
        sequence: u32,
        time_ns: u64,
        data: &'a [u8],
    },
    /// Bytes that differ from what was written. Reading continues after them.
    Damage,
    /// A chunk with an unknown compression, and its name.
    Compressed(String),
    /// The end, with footer and final magic.
    End,
    /// The bytes end, or are not valid any more, before the end.
    Cut,
}

/// A decoded record whose bytes are still in the buffer.
enum Step {
    Channel {
        id: u16,
        topic: String,
        encoding: String,
        schema: Arc<Schema>,
    },
    Metadata {
        name: String,
        map: BTreeMap<String, String>,
    },
    Message {
        channel: u16,
        sequence: u32,
        time_ns: u64,
        data: Range<usize>,
    },
    Nothing,
}

/// The schema of the messages of a channel.
#[derive(Debug, Default)]
pub(crate) struct Schema {
    pub(crate) name: String,
    /// Encoding of `text`.
    pub(crate) encoding: String,
    /// Empty if the schema is not a text.
    pub(crate) text: String,
}

/// Totals of the messages in a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Statistics {
    /// Time of the last message, ns.
    pub(crate) last_ns: u64,
    /// Number of messages of each channel.
    pub(crate) counts: BTreeMap<u16, u64>,
}

/// Reads a file once, from its start. Its memory is bounded by the largest record and the schemas.
#[derive(Debug)]
pub(crate) struct Scanner<R> {
    source: Source<R>,
    /// The chunk, or the record outside of chunks, that is being read.
    buffer: Vec<u8>,
    /// The part of the buffer that is still to be read.
    rest: Range<usize>,
    schemas: BTreeMap<u16, Arc<Schema>>,
    /// Whether the data have ended and the summary is being read.
    is_in_summary: bool,
    /// Whether a checksum of the file shows that its bytes have changed anywhere.
    is_altered: bool,
    statistics: Option<Statistics>,
}

impl<R: Read> Scanner<R> {
    /// `None` if the file does not start like an MCAP file.
    pub(crate) fn open(source: R) -> io::Result<Option<Self>> {
        let (mut source, mut magic) = (Source::new(source), Vec::new());
        source.read(MAGIC.len() as u64, &mut magic)?;
        Ok((magic == MAGIC).then(|| Self {
            source,
            buffer: Vec::new(),
            rest: 0..0,
            schemas: BTreeMap::new(),
            is_in_summary: false,
            is_altered: false,
            statistics: None,
        }))
    }

    /// Whether a checksum of the file shows that its bytes have changed. Known at [`Found::End`].
    pub(crate) fn is_altered(&self) -> bool {
        self.is_altered
    }

    /// The totals in the summary, if the summary exists and is undamaged. Known at [`Found::End`].
    pub(crate) fn statistics(&self) -> Option<&Statistics> {
        self.statistics.as_ref()
    }

    /// The next item. Nothing follows [`Found::End`] and [`Found::Cut`].
    pub(crate) fn next(&mut self) -> io::Result<Found<'_>> {
        loop {
            if self.rest.is_empty() {
                match self.next_record()? {
                    None => {}
                    Some(found) => return Ok(found),
                }
                continue;
            }
            match self.step() {
                Some(Step::Nothing) => {}
                Some(Step::Channel {
                    id,
                    topic,
                    encoding,
                    schema,
                }) => {
                    return Ok(Found::Channel {
                        id,
                        topic,
                        encoding,
                        schema,
                    });
                }
                Some(Step::Metadata { name, map }) => return Ok(Found::Metadata { name, map }),
                Some(Step::Message {
                    channel,
                    sequence,
                    time_ns,
                    data,
                }) => {
                    return Ok(Found::Message {
                        channel,
                        sequence,
                        time_ns,
                        data: &self.buffer[data],
                    });
                }
                None => {
                    self.rest = 0..0;
                    return Ok(Found::Damage);
                }
            }
        }
    }

    /// Reads the next record outside of chunks. Its content becomes the rest.
    fn next_record(&mut self) -> io::Result<Option<Found<'static>>> {
        let before = self.source.checksum();
        self.buffer.clear();
        if !self.read(FRAMING_BYTES as u64)? {
            return Ok(Some(Found::Cut));
        }
        let (kind, length) = framing(&self.buffer).expect("as many bytes were read");
        if kind == op::ATTACHMENT || kind > op::DATA_END {
            return Ok((!self.source.skip(length)?).then_some(Found::Cut));
        }
        // Some records state their length twice. A wrong length is found here, before the bytes
        // that follow are taken for the content of the record.
        let header_bytes = length.min(HEADER_BYTES as u64);
        let has_header = self.read(header_bytes)?;
        if has_header && !is_plausible(&self.buffer) {
            return self.go_to_next_chunk();
        }
        if !has_header || !self.read(length - header_bytes)? {
            return Ok(Some(Found::Cut));
        }
        let mut content = Take(&self.buffer[FRAMING_BYTES..]);
        match kind {
            op::CHUNK => return Ok(self.open_chunk().unwrap_or(Some(Found::Damage))),
            op::FOOTER => return self.end(before),
            op::DATA_END => {
                self.is_altered |= differs(content.u32(), before.clone().finalize());
                self.is_in_summary = true;
                self.source.begin_section();
            }
            op::STATISTICS => self.statistics = take_statistics(content),
            op::SCHEMA | op::CHANNEL | op::MESSAGE | op::METADATA => self.rest = 0..self.buffer.len(),
            _ => {}
        }
        Ok(None)
    }

    /// Searches for the next chunk, or the end of the data, after a record that is not valid.
    fn go_to_next_chunk(&mut self) -> io::Result<Option<Found<'static>>> {
        self.is_altered = true;
        let seen = self.buffer.split_off(1);
        let begins = |bytes: &[u8]| matches!(bytes[0], op::CHUNK | op::DATA_END) && is_plausible(bytes);
        let is_found = self.source.go_to(seen, FRAMING_BYTES + HEADER_BYTES, begins)?;
        Ok(Some(if is_found { Found::Damage } else { Found::Cut }))
    }

    /// Reads on after the footer, which is in the buffer, and compares the checksum of the summary,
    /// which covers the footer's first two fields. `before` is the checksum before the footer.
    fn end(&mut self, mut before: Hasher) -> io::Result<Option<Found<'static>>> {
        let (checked, own) = self.buffer.split_at(FRAMING_BYTES + 16);
        before.update(checked);
        let is_other = differs(Take(own).u32(), before.finalize());
        if is_other || !self.is_in_summary {
            (self.is_altered, self.statistics) = (true, None);
        }
        self.buffer.clear();
        self.read(MAGIC.len() as u64)?;
        Ok(Some(if self.buffer == MAGIC {
            Found::End
        } else {
            Found::Cut
        }))
    }

    /// Appends bytes to the buffer, which grows only with bytes that exist. False if they end too
    /// early.
    fn read(&mut self, length: u64) -> io::Result<bool> {
        self.source.read(length, &mut self.buffer)
    }

    /// Makes the messages of the chunk in the buffer the rest. `None` if the chunk is damaged.
    fn open_chunk(&mut self) -> Option<Option<Found<'static>>> {
        let mut chunk = Take(self.buffer.get(FRAMING_BYTES..)?);
        let (_earliest_ns, _latest_ns, unpacked_bytes) = (chunk.u64()?, chunk.u64()?, chunk.u64()?);
        let checksum = chunk.u32()?;
        let compression = chunk.string()?;
        let length = chunk.u64()?;
        let records = chunk.bytes(length)?;
        // A checksum of 0 means that there is none.
        let is_whole = |records: &[u8]| checksum == 0 || checksum == crc32fast::hash(records);
        if compression.is_empty() {
            let end = self.buffer.len() - chunk.0.len();
            self.rest = is_whole(records).then(|| end - records.len()..end)?;
            return Some(None);
        }
        match unpack(compression, records, unpacked_bytes) {
            Unpacked::Whole(records) if is_whole(&records) => {
                self.rest = 0..records.len();
                self.buffer = records;
                Some(None)
            }
            Unpacked::Whole(_) | Unpacked::Damaged => None,
            Unpacked::Unknown => Some(Some(Found::Compressed(compression.to_owned()))),
        }
    }

    /// Takes one record from the rest. `None` if it is damaged.
    fn step(&mut self) -> Option<Step> {
        let mut rest = Take(self.buffer.get(self.rest.clone())?);
        let kind = rest.u8()?;
        let length = rest.u64()?;
        let mut content = Take(rest.bytes(length)?);
        self.rest.start = self.rest.end - rest.0.len();
        Some(match kind {
            op::SCHEMA => {
                let (id, name, encoding) = (content.u16()?, content.string()?, content.string()?);
                let length = content.u32()?;
                let text = String::from_utf8(content.bytes(length.into())?.to_owned());
                let schema = Schema {
                    name: name.to_owned(),
                    encoding: encoding.to_owned(),
                    text: text.unwrap_or_default(),
                };
                self.schemas.insert(id, Arc::new(schema));
                Step::Nothing
            }
            op::CHANNEL => {
                let (id, schema) = (content.u16()?, content.u16()?);
                Step::Channel {
                    id,
                    topic: content.string()?.to_owned(),
                    encoding: content.string()?.to_owned(),
                    schema: self.schemas.get(&schema).cloned().unwrap_or_default(),
                }
            }
            op::MESSAGE => {
                let (channel, sequence) = (content.u16()?, content.u32()?);
                let (time_ns, _published_ns) = (content.u64()?, content.u64()?);
                let data = self.rest.start - content.0.len()..self.rest.start;
                Step::Message {
                    channel,
                    sequence,
                    time_ns,
                    data,
                }
            }
            op::METADATA => Step::Metadata {
                name: content.string()?.to_owned(),
                map: content.map()?,
            },
            _ => Step::Nothing,
        })
    }
}

/// Kind and length of the record at the start of the bytes.
fn framing(bytes: &[u8]) -> Option<(u8, u64)> {
    let mut framing = Take(bytes);
    Some((framing.u8()?, framing.u64()?))
}

/// Whether a record can have its stated length, judged by its first bytes.
fn is_plausible(bytes: &[u8]) -> bool {
    let Some((kind, length)) = framing(bytes) else {
        return false;
    };
    let content = Take(&bytes[FRAMING_BYTES..]);
    length <= LARGEST_RECORD_BYTES
        && match kind {
            0 => false, // a file system leaves zeros where it has lost what was written
            op::CHUNK => chunk_bytes(content) == Some(length),
            op::MESSAGE_INDEX => index_bytes(content) == Some(length),
            op::DATA_END => length == 4,
            op::FOOTER => length == 20,
            op::SUMMARY_OFFSET => length == 17,
            _ => true,
        }
}

/// Length of a chunk, computed from its header.
fn chunk_bytes(mut chunk: Take<'_>) -> Option<u64> {
    let (_earliest_ns, _latest_ns, _length, _checksum) =
        (chunk.u64()?, chunk.u64()?, chunk.u64()?, chunk.u32()?);
    let compression = chunk.string()?;
    chunk.u64()?.checked_add(40 + compression.len() as u64)
}

/// Length of a message index, computed from its header.
fn index_bytes(mut index: Take<'_>) -> Option<u64> {
    let (_channel, length) = (index.u16()?, index.u32()?);
    Some(6 + u64::from(length))
}

/// Whether a stored checksum differs from the computed one. A stored checksum of 0 means that there
/// is none.
fn differs(written: Option<u32>, found: u32) -> bool {
    written.is_none_or(|written| written != 0 && written != found)
}

fn take_statistics(mut content: Take<'_>) -> Option<Statistics> {
    let (_messages, _schemas) = (content.u64()?, content.u16()?);
    let (_channels, _attachments, _metadata, _chunks) =
        (content.u32()?, content.u32()?, content.u32()?, content.u32()?);
    let (_first_ns, last_ns) = (content.u64()?, content.u64()?);
    let length = content.u32()?;
    let mut pairs = Take(content.bytes(length.into())?);
    let mut counts = BTreeMap::new();
    while !pairs.0.is_empty() {
        counts.insert(pairs.u16()?, pairs.u64()?);
    }
    Some(Statistics { last_ns, counts })
}
