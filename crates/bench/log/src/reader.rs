//! An MCAP file in, messages out.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use crate::mcap::{Found, Scanner};
use crate::ros::{decode, stream_of};
use crate::writer::DESCRIPTION;
use crate::{Body, Description, Event, LogError, Message, Stream};

/// How a log ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// It was finished.
    Whole,
    /// It was cut, or its end is damaged: this is what was flushed before.
    Cut,
}

/// Reads a log from its start, whole or cut: an iterator over its messages, in the order in which they were written.
///
/// Messages that were damaged on the disk become an [`Event::Gap`] in all streams. Channels of others are passed over. Memory
/// does not grow with the file.
#[derive(Debug)]
pub struct LogReader<R> {
    scanner: Scanner<R>,
    file: String,
    description: Description,
    /// What is read back, by number of the channel.
    streams: BTreeMap<u16, Stream>,
    /// Latest time so far, on the bench's clock, ns.
    latest_ns: u64,
    is_damaged: bool,
    /// The message behind a gap.
    held: Option<Message>,
    ending: Option<Ending>,
}

impl LogReader<BufReader<File>> {
    /// Opens a file.
    ///
    /// # Errors
    /// A file that cannot be read, or is no log.
    pub fn open(path: &Path) -> Result<Self, LogError> {
        let file = File::open(path).map_err(|source| LogError::read(path, source))?;
        Self::new(BufReader::new(file), &path.display().to_string())
    }
}

impl<R: Read> LogReader<R> {
    /// Reads a log from anything; `file` names it in errors.
    ///
    /// # Errors
    /// As for [`open`](LogReader::open).
    pub fn new(source: R, file: &str) -> Result<Self, LogError> {
        let not_a_log = |problem: String| LogError::NotALog {
            file: file.to_owned(),
            problem,
        };
        let read = |source| LogError::Read {
            file: file.to_owned(),
            source,
        };
        let mut scanner = Scanner::open(source)
            .map_err(read)?
            .ok_or_else(|| not_a_log("it does not start as an MCAP file".to_owned()))?;
        let mut streams = BTreeMap::new();
        let map = loop {
            match scanner.next().map_err(read)? {
                Found::Metadata { name, map } if name == DESCRIPTION => break map,
                Found::Channel { id, topic, schema } => note(&mut streams, id, &topic, &schema),
                Found::Metadata { .. } => {}
                Found::Cut => {
                    return Err(not_a_log("it ends before its description".to_owned()));
                }
                _ => return Err(not_a_log("it has no description at its start".to_owned())),
            }
        };
        Ok(Self {
            description: Description::from_map(&map).map_err(not_a_log)?,
            scanner,
            file: file.to_owned(),
            streams,
            latest_ns: 0,
            is_damaged: false,
            held: None,
            ending: None,
        })
    }

    /// What the log is about.
    #[must_use]
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// How the log ends; known when its last message was read.
    #[must_use]
    pub fn ending(&self) -> Option<Ending> {
        self.ending
    }

    /// The name for errors.
    pub(crate) fn file(&self) -> &str {
        &self.file
    }

    /// The next message that is whole, and `None` at the end.
    fn next_whole(&mut self) -> Result<Option<Message>, LogError> {
        while self.ending.is_none() {
            let found = self.scanner.next().map_err(|source| LogError::Read {
                file: self.file.clone(),
                source,
            })?;
            match found {
                Found::Message {
                    channel,
                    time_ns,
                    data,
                } => {
                    let Some(stream) = self.streams.get(&channel) else {
                        continue;
                    };
                    match message(*stream, time_ns, data, &self.description) {
                        Some(message) => return Ok(Some(message)),
                        None => self.is_damaged = true,
                    }
                }
                Found::Channel { id, topic, schema } => note(&mut self.streams, id, &topic, &schema),
                Found::Metadata { .. } => {}
                Found::Damage => self.is_damaged = true,
                Found::Compressed(how) => {
                    return Err(LogError::NotALog {
                        file: self.file.clone(),
                        problem: format!("it is compressed with `{how}`; `mcap decompress` undoes that"),
                    });
                }
                Found::End => self.ending = Some(Ending::Whole),
                Found::Cut => self.ending = Some(Ending::Cut),
            }
        }
        Ok(None)
    }

    fn next_or_gap(&mut self) -> Result<Option<Message>, LogError> {
        if let Some(held) = self.held.take() {
            return Ok(Some(held));
        }
        let next = self.next_whole()?;
        let from_ns = self.latest_ns;
        self.latest_ns = next
            .as_ref()
            .map_or(from_ns, |message| message.bench_ns.max(from_ns));
        if !std::mem::take(&mut self.is_damaged) {
            return Ok(next);
        }
        self.held = next;
        let gap = Event::Gap {
            stream: None,
            cause: "the file is damaged".to_owned(),
            from_ns,
            to_ns: self.latest_ns,
            lost: None,
        };
        Ok(Some(Message {
            bench_ns: from_ns,
            body: Body::Event(gap),
        }))
    }
}

impl<R: Read> Iterator for LogReader<R> {
    type Item = Result<Message, LogError>;

    /// The next message. After an error there is none.
    fn next(&mut self) -> Option<Self::Item> {
        let next = self.next_or_gap();
        if next.is_err() {
            self.ending = Some(Ending::Cut);
        }
        next.transpose()
    }
}

fn note(streams: &mut BTreeMap<u16, Stream>, id: u16, topic: &str, schema: &str) {
    if let Some(stream) = stream_of(topic, schema) {
        streams.insert(id, stream);
    }
}

/// A message that is what its channel holds and what the description promises.
fn message(stream: Stream, unix_ns: u64, data: &[u8], description: &Description) -> Option<Message> {
    let bench_ns = unix_ns.checked_sub(description.start_unix_ns)?;
    let body = decode(stream, data)?;
    if let Body::Tactile(frame) = &body
        && frame.taxels.len() != description.taxels.len()
    {
        return None;
    }
    Some(Message { bench_ns, body })
}
