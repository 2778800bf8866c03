//! Records from first to last, as far as the bytes go.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::ops::Range;

use super::take::Take;
use super::{MAGIC, op};

/// Largest record that is read; longer ones are damage. Chunks of common writers have a few MB.
const LARGEST_RECORD_BYTES: u64 = 64 << 20;
const FRAMING_BYTES: usize = 9;

/// Something in a file.
#[derive(Debug)]
pub(crate) enum Found<'a> {
    /// A channel, with the name of its schema.
    Channel { id: u16, topic: String, schema: String },
    /// Texts about the file.
    Metadata {
        name: String,
        map: BTreeMap<String, String>,
    },
    /// A message of a channel.
    Message {
        channel: u16,
        time_ns: u64,
        data: &'a [u8],
    },
    /// A record that is not what was written; reading goes on behind it.
    Damage,
    /// A chunk that is compressed, and how.
    Compressed(String),
    /// The end, with footer and last magic.
    End,
    /// The bytes end, or make no sense any more, before the end.
    Cut,
}

/// A record that is taken apart, with its bytes still in the buffer.
enum Step {
    Channel {
        id: u16,
        topic: String,
        schema: String,
    },
    Metadata {
        name: String,
        map: BTreeMap<String, String>,
    },
    Message {
        channel: u16,
        time_ns: u64,
        data: Range<usize>,
    },
    Nothing,
}

/// Reads a file once, from its start. Its memory is bounded by its largest record and the names of its schemas.
#[derive(Debug)]
pub(crate) struct Scanner<R> {
    source: R,
    /// The chunk, or the one record outside chunks, that is being read.
    buffer: Vec<u8>,
    /// The part of it that is still to be read.
    rest: Range<usize>,
    schemas: BTreeMap<u16, String>,
}

impl<R: Read> Scanner<R> {
    /// `None` if the file does not start as one of MCAP.
    pub(crate) fn open(mut source: R) -> io::Result<Option<Self>> {
        let mut magic = Vec::new();
        (&mut source).take(MAGIC.len() as u64).read_to_end(&mut magic)?;
        Ok((magic == MAGIC).then(|| Self {
            source,
            buffer: Vec::new(),
            rest: 0..0,
            schemas: BTreeMap::new(),
        }))
    }

    /// What comes next. Nothing comes after [`Found::End`] and [`Found::Cut`].
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
                Some(Step::Channel { id, topic, schema }) => return Ok(Found::Channel { id, topic, schema }),
                Some(Step::Metadata { name, map }) => return Ok(Found::Metadata { name, map }),
                Some(Step::Message {
                    channel,
                    time_ns,
                    data,
                }) => {
                    return Ok(Found::Message {
                        channel,
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

    /// Reads the next record outside chunks; what is in it becomes the rest.
    fn next_record(&mut self) -> io::Result<Option<Found<'static>>> {
        self.buffer.clear();
        if !self.read(FRAMING_BYTES as u64)? {
            return Ok(Some(Found::Cut));
        }
        let mut framing = Take(&self.buffer);
        let (Some(kind), Some(length)) = (framing.u8(), framing.u64()) else {
            return Ok(Some(Found::Cut));
        };
        let is_read = [
            op::SCHEMA,
            op::CHANNEL,
            op::MESSAGE,
            op::CHUNK,
            op::METADATA,
            op::FOOTER,
        ]
        .contains(&kind);
        // No kind has the number 0: such bytes are where a file system has lost what was written.
        if kind == 0 || is_read && length > LARGEST_RECORD_BYTES {
            return Ok(Some(Found::Cut));
        }
        if !is_read {
            let skipped = io::copy(&mut (&mut self.source).take(length), &mut io::sink())?;
            return Ok((skipped < length).then_some(Found::Cut));
        }
        if !self.read(length)? {
            return Ok(Some(Found::Cut));
        }
        match kind {
            op::FOOTER => {
                self.buffer.clear();
                self.read(MAGIC.len() as u64)?;
                let is_whole = self.buffer == MAGIC;
                Ok(Some(if is_whole { Found::End } else { Found::Cut }))
            }
            op::CHUNK => Ok(self.open_chunk().unwrap_or(Some(Found::Damage))),
            _ => {
                self.rest = 0..self.buffer.len();
                Ok(None)
            }
        }
    }

    /// Appends bytes to the buffer, which grows with those that come; false if they end before.
    fn read(&mut self, length: u64) -> io::Result<bool> {
        let come = (&mut self.source).take(length).read_to_end(&mut self.buffer)?;
        Ok(come as u64 == length)
    }

    /// Lets the messages of the chunk in the buffer be the rest; `None` if it is damaged.
    fn open_chunk(&mut self) -> Option<Option<Found<'static>>> {
        let mut chunk = Take(self.buffer.get(FRAMING_BYTES..)?);
        let (_earliest_ns, _latest_ns, _length) = (chunk.u64()?, chunk.u64()?, chunk.u64()?);
        let checksum = chunk.u32()?;
        let compression = chunk.string()?;
        let length = chunk.u64()?;
        let records = chunk.bytes(length)?;
        if !compression.is_empty() {
            return Some(Some(Found::Compressed(compression.to_owned())));
        }
        // A checksum of 0 stands for none.
        if checksum != 0 && checksum != crc32fast::hash(records) {
            return None;
        }
        let end = self.buffer.len() - chunk.0.len();
        self.rest = end - records.len()..end;
        Some(None)
    }

    /// Takes one record off the rest; `None` if it is damaged.
    fn step(&mut self) -> Option<Step> {
        let mut rest = Take(self.buffer.get(self.rest.clone())?);
        let kind = rest.u8()?;
        let length = rest.u64()?;
        let mut content = Take(rest.bytes(length)?);
        self.rest.start = self.rest.end - rest.0.len();
        Some(match kind {
            op::SCHEMA => {
                let (id, name) = (content.u16()?, content.string()?.to_owned());
                self.schemas.insert(id, name);
                Step::Nothing
            }
            op::CHANNEL => {
                let (id, schema) = (content.u16()?, content.u16()?);
                Step::Channel {
                    id,
                    topic: content.string()?.to_owned(),
                    schema: self.schemas.get(&schema).cloned().unwrap_or_default(),
                }
            }
            op::MESSAGE => {
                let (channel, _sequence) = (content.u16()?, content.u32()?);
                let (time_ns, _published_ns) = (content.u64()?, content.u64()?);
                let data = self.rest.start - content.0.len()..self.rest.start;
                Step::Message {
                    channel,
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
