//! Writes messages to an MCAP file.

use std::collections::BTreeMap;

use crate::accepts::Accepts;
use crate::cdr::Encoder;
use crate::mcap::{Chunk, MAGIC, Records, Summary, number, op};
use crate::ros::{MESSAGE_ENCODING, SCHEMA_ENCODING, TopicNames, Topics};
use crate::{Description, LogError, Message, Sink};

/// Longest time, ns of the bench clock, that a message waits to be flushed while other messages
/// follow it.
pub(crate) const FLUSH_NS: u64 = 500_000_000;
/// Size of a chunk from which on it is flushed, bytes.
const CHUNK_BYTES: usize = 1 << 20;
/// Name of the metadata with the description.
pub(crate) const DESCRIPTION: &str = "twintac";
/// Name of the metadata with the provenance of an exported bag.
pub(crate) const EXPORTED: &str = "twintac_export";

/// Writes a log. What was flushed stays readable in any case, also without
/// [`finish`](Self::finish).
///
/// The same description and messages give the same bytes.
#[derive(Debug)]
pub struct LogWriter<S: Sink> {
    sink: S,
    topics: Topics,
    accepts: Accepts,
    chunk: Chunk,
    /// Number of the next message of each channel.
    sequences: Vec<u32>,
    summary: Summary,
    /// Number of written bytes, and their checksum.
    written: u64,
    checksum: crc32fast::Hasher,
    /// Why nothing can be written any more.
    failure: Option<String>,
    out: Records,
}

impl<S: Sink> LogWriter<S> {
    /// Begins a log and flushes its description.
    ///
    /// # Errors
    /// A description that is not consistent; a sink that fails.
    pub fn new(sink: S, description: &Description) -> Result<Self, LogError> {
        let metadata = description.to_map()?;
        let topics = Topics::new(&description.taxels);
        Self::begin(sink, description, topics, DESCRIPTION, &metadata)
    }

    /// Begins a bag with standard messages only. It is no log: it lacks what is needed to read it
    /// as a log.
    pub(crate) fn standard(sink: S, description: &Description, names: &TopicNames) -> Result<Self, LogError> {
        names.check()?;
        let mut metadata = description.to_map()?;
        metadata.retain(|field, _| ["sensor", "provenance", "taxels"].contains(&&**field));
        let topics = Topics::standard(&description.taxels, names);
        Self::begin(sink, description, topics, EXPORTED, &metadata)
    }

    fn begin(
        sink: S,
        description: &Description,
        topics: Topics,
        name: &str,
        metadata: &BTreeMap<String, String>,
    ) -> Result<Self, LogError> {
        let channels = topics.channels.len();
        let mut writer = Self {
            sink,
            accepts: Accepts::new(description),
            chunk: Chunk::new(channels),
            sequences: vec![0; channels],
            summary: Summary::new(channels, topics.definitions.len()),
            written: 0,
            checksum: crc32fast::Hasher::new(),
            failure: None,
            out: Records::default(),
            topics,
        };
        let out = &mut writer.out;
        out.bytes.extend(MAGIC);
        out.header("ros2", concat!("twintac ", env!("CARGO_PKG_VERSION")));
        for (_, records) in declarations(&writer.topics) {
            out.bytes.extend(records.bytes);
        }
        let start = out.bytes.len();
        out.metadata(name, metadata);
        let length = out.bytes.len() - start;
        writer.summary.add_metadata(name, start as u64, length as u64);
        writer.append()?;
        Ok(writer)
    }

    /// Adds a message. First flushes the earlier messages if the oldest is half a second older than
    /// this one, or if they are many.
    ///
    /// # Errors
    /// [`LogError::Invalid`]: a frame with another number of taxels, an event that cannot be JSON,
    /// or a time beyond 64 bits; nothing was added, and the next message can be written.
    /// [`LogError::Write`] and then [`LogError::Stopped`]: the sink has failed permanently.
    pub fn write(&mut self, message: &Message) -> Result<(), LogError> {
        self.check_running()?;
        let unix_ns = self.accepts.check(message)?;
        let is_due = self
            .chunk
            .span_ns()
            .is_some_and(|(earliest_ns, _)| unix_ns >= earliest_ns.saturating_add(FLUSH_NS));
        if is_due || self.chunk.len_bytes() >= CHUNK_BYTES {
            self.flush()?;
        }
        let (chunk, sequences) = (&mut self.chunk, &mut self.sequences);
        self.topics.each(unix_ns, &message.body, |channel, put| {
            let sequence = &mut sequences[channel];
            chunk.add(channel, *sequence, unix_ns, |bytes| put(&mut Encoder::new(bytes)));
            *sequence = sequence.wrapping_add(1);
        });
        Ok(())
    }

    /// Writes and syncs the waiting messages.
    ///
    /// # Errors
    /// [`LogError::Write`] and then [`LogError::Stopped`]: the sink has failed permanently.
    pub fn flush(&mut self) -> Result<(), LogError> {
        self.check_running()?;
        if self.chunk.is_empty() {
            return Ok(());
        }
        self.summary
            .add_chunk(&mut self.chunk, self.written, &mut self.out);
        self.append()
    }

    /// Flushes, writes the index of the whole log, and gives a file its final name.
    ///
    /// # Errors
    /// As [`flush`](Self::flush).
    pub fn finish(mut self) -> Result<S, LogError> {
        self.close()?;
        Ok(self.sink)
    }

    pub(crate) fn close(&mut self) -> Result<(), LogError> {
        self.flush()?;
        let checksum = self.checksum.clone().finalize();
        self.out.bytes = self
            .summary
            .close(self.written, checksum, &declarations(&self.topics));
        self.append()?;
        let completed = self.sink.complete();
        self.latch(completed)
    }

    /// Number of written bytes, without waiting messages.
    #[must_use]
    pub fn written_bytes(&self) -> u64 {
        self.written
    }

    fn check_running(&self) -> Result<(), LogError> {
        match &self.failure {
            Some(why) => Err(LogError::Stopped { why: why.clone() }),
            None => Ok(()),
        }
    }

    /// Writes and syncs the content of `out`.
    fn append(&mut self) -> Result<(), LogError> {
        let written = self
            .sink
            .write_all(&self.out.bytes)
            .and_then(|()| self.sink.flush())
            .and_then(|()| self.sink.sync());
        self.checksum.update(&self.out.bytes);
        self.written += self.out.bytes.len() as u64;
        self.out.bytes.clear();
        self.latch(written)
    }

    fn latch(&mut self, result: std::io::Result<()>) -> Result<(), LogError> {
        result.map_err(|source| {
            let file = self.sink.name();
            let error = LogError::Write { file, source };
            self.failure = Some(error.to_string());
            error
        })
    }
}

/// Schemas and channels. They are written at the start of a file and in its summary.
fn declarations(topics: &Topics) -> [(u8, Records); 2] {
    let mut schemas = Records::default();
    for (place, definition) in topics.definitions.iter().enumerate() {
        schemas.schema(number(place), definition.name, SCHEMA_ENCODING, definition.text);
    }
    // ROS players expect this entry. No quality of service was offered, because no publisher was
    // involved.
    let metadata = BTreeMap::from([("offered_qos_profiles".to_owned(), String::new())]);
    let mut channels = Records::default();
    for (place, (topic, schema)) in topics.channels.iter().enumerate() {
        channels.channel(number(place), number(*schema), topic, MESSAGE_ENCODING, &metadata);
    }
    [(op::SCHEMA, schemas), (op::CHANNEL, channels)]
}
