//! Detects streams that fall silent.

use super::Cause;

/// One stream of a supervisor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StreamId(usize);

impl StreamId {
    /// The force sensor's stream, which every supervisor watches.
    pub const FORCE: Self = Self(0);
    /// The robot's reports, which every supervisor watches.
    pub const ROBOT: Self = Self(1);
}

#[derive(Clone, Debug)]
struct Stream {
    name: String,
    longest_silence_s: f64,
    heard_s: f64,
    failed: bool,
}

impl Stream {
    fn silence_s(&self, now_s: f64) -> f64 {
        now_s - self.heard_s
    }

    /// Whether the stream is alive. It is not if the time is NaN.
    fn is_alive(&self, now_s: f64) -> bool {
        !self.failed && self.silence_s(now_s) <= self.longest_silence_s
    }
}

/// When each stream was last heard, and its longest allowed silence.
#[derive(Clone, Debug, Default)]
pub(super) struct Watchdog {
    streams: Vec<Stream>,
}

impl Watchdog {
    /// Watches a stream from now on.
    pub(super) fn watch(&mut self, name: &str, longest_silence_s: f64, now_s: f64) -> StreamId {
        self.streams.push(Stream {
            name: name.to_owned(),
            longest_silence_s,
            heard_s: now_s,
            failed: false,
        });
        StreamId(self.streams.len() - 1)
    }

    pub(super) fn heard(&mut self, stream: StreamId, now_s: f64) {
        if let Some(stream) = self.streams.get_mut(stream.0) {
            stream.heard_s = now_s;
        }
    }

    /// Counts a stream as dead, also if it is heard again later.
    pub(super) fn fail(&mut self, stream: StreamId) {
        if let Some(stream) = self.streams.get_mut(stream.0) {
            stream.failed = true;
        }
    }

    pub(super) fn is_alive(&self, stream: StreamId, now_s: f64) -> bool {
        self.streams
            .get(stream.0)
            .is_some_and(|stream| stream.is_alive(now_s))
    }

    pub(super) fn name(&self, stream: StreamId) -> String {
        self.streams.get(stream.0).map_or_else(
            || "a stream of another supervisor".to_owned(),
            |stream| stream.name.clone(),
        )
    }

    /// The first stream that has been silent for too long.
    pub(super) fn silent(&self, now_s: f64) -> Option<Cause> {
        self.streams
            .iter()
            .find(|stream| !stream.is_alive(now_s))
            .map(|stream| Cause::StreamSilent {
                stream: stream.name.clone(),
                silence_s: stream.silence_s(now_s),
                longest_silence_s: stream.longest_silence_s,
            })
    }
}
