//! Reads messages from an MCAP file.

use std::collections::VecDeque;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use crate::channels::{Channels, DAMAGED};
use crate::mcap::{Found, Scanner};
use crate::ros::decode;
use crate::writer::DESCRIPTION;
use crate::{Body, Description, Event, LogError, Message, Stream};

/// How a log ends, and whether it is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// It was finished, and all its checksums match.
    Whole,
    /// It was finished, but has changed since. Missing messages are marked as gaps. Without a gap,
    /// the change is outside of the messages: what the log says about the sensor and the test setup
    /// may be wrong.
    Damaged,
    /// It was cut, or its end is damaged. The log holds what was flushed before.
    Cut,
}

/// Reads a log from its start, complete or cut: an iterator over its messages, in the order in
/// which they were written.
///
/// Messages that were damaged on the disk, or whose numbers are missing, become an [`Event::Gap`].
/// Channels of other programs are skipped. Memory does not grow with the file.
#[derive(Debug)]
pub struct LogReader<R> {
    scanner: Scanner<R>,
    file: String,
    description: Description,
    /// The channels that are read back, by number.
    channels: Channels,
    /// Latest time so far on the bench clock, ns.
    latest_ns: u64,
    /// Whether something is missing before the next message.
    is_damaged: bool,
    /// Whether something was missing.
    was_damaged: bool,
    /// Gaps, and the message after them.
    held: VecDeque<Message>,
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
    /// Reads a log from any reader. `file` is the name in errors.
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
        let mut channels = Channels::default();
        let map = loop {
            match scanner.next().map_err(read)? {
                Found::Metadata { name, map } if name == DESCRIPTION => break map,
                Found::Channel {
                    id, topic, schema, ..
                } => channels.note(id, &topic, &schema.name),
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
            channels,
            latest_ns: 0,
            is_damaged: false,
            was_damaged: false,
            held: VecDeque::new(),
            ending: None,
        })
    }

    /// The description of the log.
    #[must_use]
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// How the log ends. Known when its last message was read.
    #[must_use]
    pub fn ending(&self) -> Option<Ending> {
        self.ending
    }

    /// The name in errors.
    pub(crate) fn file(&self) -> &str {
        &self.file
    }

    /// The next undamaged message. `None` at the end.
    fn next_whole(&mut self) -> Result<Option<Message>, LogError> {
        while self.ending.is_none() {
            let found = self.scanner.next().map_err(|source| LogError::Read {
                file: self.file.clone(),
                source,
            })?;
            match found {
                Found::Message {
                    channel,
                    sequence,
                    time_ns,
                    data,
                } => {
                    let Some((stream, is_after_loss)) = self.channels.count(channel, sequence) else {
                        continue;
                    };
                    self.is_damaged |= is_after_loss;
                    match message(stream, time_ns, data, &self.description) {
                        Some(message) => {
                            self.channels.note_time(channel, message.bench_ns);
                            return Ok(Some(message));
                        }
                        None => self.is_damaged = true,
                    }
                }
                Found::Channel {
                    id, topic, schema, ..
                } => self.channels.note(id, &topic, &schema.name),
                Found::Metadata { .. } => {}
                Found::Damage => self.is_damaged = true,
                Found::Compressed(how) => {
                    return Err(LogError::NotALog {
                        file: self.file.clone(),
                        problem: format!(
                            "it is compressed with `{how}`, expected zstd, lz4 or none; `mcap decompress` undoes that"
                        ),
                    });
                }
                Found::End => self.end(),
                Found::Cut => self.ending = Some(Ending::Cut),
            }
        }
        Ok(None)
    }

    /// Compares what was read with the totals that the file states.
    fn end(&mut self) {
        if let Some(statistics) = self.scanner.statistics() {
            let to_ns = statistics.last_ns.saturating_sub(self.description.start_unix_ns);
            for gap in self.channels.gaps_at_end(statistics, to_ns) {
                self.hold(gap);
            }
        }
        let is_whole =
            !self.scanner.is_altered() && !self.is_damaged && !self.was_damaged && self.held.is_empty();
        self.ending = Some(if is_whole { Ending::Whole } else { Ending::Damaged });
    }

    fn hold(&mut self, gap: Event) {
        let Event::Gap { from_ns, .. } = gap else { return };
        self.held.push_back(Message {
            bench_ns: from_ns,
            body: Body::Event(gap),
        });
    }

    fn next_or_gap(&mut self) -> Result<Option<Message>, LogError> {
        if let Some(held) = self.held.pop_front() {
            return Ok(Some(held));
        }
        let next = self.next_whole()?;
        let from_ns = self.latest_ns;
        self.latest_ns = next
            .as_ref()
            .map_or(from_ns, |message| message.bench_ns.max(from_ns));
        let is_damaged = std::mem::take(&mut self.is_damaged);
        self.was_damaged |= is_damaged;
        // At the end, gaps from the summary may already describe the loss more precisely.
        if is_damaged && self.held.is_empty() {
            self.hold(Event::Gap {
                stream: None,
                cause: DAMAGED.to_owned(),
                from_ns,
                to_ns: self.latest_ns,
                lost: None,
            });
            if let Some(next) = &next {
                self.channels.excuse(next.stream());
            }
        }
        self.held.extend(next);
        Ok(self.held.pop_front())
    }
}

impl<R: Read> Iterator for LogReader<R> {
    type Item = Result<Message, LogError>;

    /// The next message. Nothing follows an error.
    fn next(&mut self) -> Option<Self::Item> {
        let next = self.next_or_gap();
        if next.is_err() {
            self.ending = Some(Ending::Cut);
        }
        next.transpose()
    }
}

/// A message, if it matches its channel and the description.
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
