//! The channels of a file, and which of their messages are missing.

use std::collections::BTreeMap;

use crate::mcap::Statistics;
use crate::ros::stream_of;
use crate::{Event, Stream};

/// Cause of the gap if messages that were written are missing.
pub(crate) const DAMAGED: &str = "the file is damaged";

/// The channels that are read back, by number.
#[derive(Debug, Default)]
pub(crate) struct Channels(BTreeMap<u16, Channel>);

#[derive(Debug)]
struct Channel {
    stream: Stream,
    /// Number of the next message.
    next: u32,
    /// Number of messages that were read or are known to be missing.
    accounted: u64,
    /// Time of the last message on the bench clock, ns.
    latest_ns: u64,
    /// Whether the messages missing since the last one are already marked by a gap.
    is_excused: bool,
}

impl Channels {
    /// A channel that the file declares. The summary declares it again.
    pub(crate) fn note(&mut self, id: u16, topic: &str, schema: &str) {
        if let Some(stream) = stream_of(topic, schema) {
            self.0.entry(id).or_insert(Channel {
                stream,
                next: 0,
                accounted: 0,
                latest_ns: 0,
                is_excused: false,
            });
        }
    }

    /// Counts a message. Returns its stream and whether messages before it are missing without a
    /// mark. `None` for a channel that is not read.
    ///
    /// Messages are numbered from 0. Programs that do not number them write 0, which is not a jump
    /// ahead.
    pub(crate) fn count(&mut self, id: u16, sequence: u32) -> Option<(Stream, bool)> {
        let channel = self.0.get_mut(&id)?;
        let missing = sequence.wrapping_sub(channel.next);
        let missing = if missing <= u32::MAX / 2 { missing } else { 0 };
        channel.accounted += 1 + u64::from(missing);
        channel.next = sequence.wrapping_add(1);
        let is_excused = std::mem::take(&mut channel.is_excused);
        Some((channel.stream, missing > 0 && !is_excused))
    }

    pub(crate) fn note_time(&mut self, id: u16, bench_ns: u64) {
        if let Some(channel) = self.0.get_mut(&id) {
            channel.latest_ns = channel.latest_ns.max(bench_ns);
        }
    }

    /// A gap in all streams is marked before a message of the stream `but`. Messages that other
    /// streams miss before their next message belong to the same gap.
    pub(crate) fn excuse(&mut self, but: Stream) {
        for channel in self.0.values_mut() {
            channel.is_excused |= channel.stream != but;
        }
    }

    /// The gaps at the end: messages of each stream that the file counts but that were not read.
    /// `to_ns` is the end on the bench clock.
    pub(crate) fn gaps_at_end(&self, statistics: &Statistics, to_ns: u64) -> Vec<Event> {
        let gap = |(id, channel): (&u16, &Channel)| {
            let count = statistics.counts.get(id).copied().unwrap_or(0);
            let missing = count
                .checked_sub(channel.accounted)
                .filter(|missing| *missing > 0)?;
            Some(Event::Gap {
                stream: Some(channel.stream),
                cause: DAMAGED.to_owned(),
                from_ns: channel.latest_ns,
                to_ns: to_ns.max(channel.latest_ns),
                lost: Some(missing),
            })
        };
        self.0.iter().filter_map(gap).collect()
    }
}
