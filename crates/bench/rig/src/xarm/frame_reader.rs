//! Reads whole frames from a connection.

use std::io::ErrorKind;
use std::time::{Duration, Instant};

use super::Wire;
use crate::{Device, RigError, Splitter};

/// A connection, with the bytes that were read and are not used yet.
#[derive(Debug)]
pub(super) struct FrameReader<W> {
    pub(super) wire: W,
    splitter: Splitter,
    chunk: Vec<u8>,
    /// The part of the chunk that was read and not yet split.
    rest: std::ops::Range<usize>,
}

impl<W: Wire> FrameReader<W> {
    pub(super) fn new(wire: W, splitter: Splitter) -> Self {
        Self {
            wire,
            splitter,
            chunk: vec![0; 4096],
            rest: 0..0,
        }
    }

    /// The next frame. `None` if it is not complete by the deadline, or, without a deadline, by
    /// now.
    pub(super) fn next(&mut self, deadline: Option<Instant>) -> Result<Option<Vec<u8>>, RigError> {
        loop {
            let mut bytes = &self.chunk[self.rest.clone()];
            let frame = self.splitter.take(&mut bytes);
            self.rest.start = self.rest.end - bytes.len();
            if let Some(frame) = frame? {
                return Ok(Some(frame));
            }
            let left = deadline.map(|deadline| deadline.saturating_duration_since(Instant::now()));
            if left.is_some_and(|left| left.is_zero()) {
                return Ok(None);
            }
            self.wire
                .limit_reads(left.unwrap_or(Duration::ZERO))
                .map_err(|found| transport("setting a time-out", found))?;
            match self.wire.read(&mut self.chunk) {
                Ok(0) => return Err(transport("receiving", ErrorKind::UnexpectedEof.into())),
                Ok(size) => self.rest = 0..size,
                Err(found) => match found.kind() {
                    ErrorKind::WouldBlock | ErrorKind::TimedOut if left.is_none() => return Ok(None),
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => {}
                    _ => return Err(transport("receiving", found)),
                },
            }
        }
    }
}

pub(super) fn transport(what: &str, source: std::io::Error) -> RigError {
    RigError::Transport {
        device: Device::Robot,
        what: what.to_owned(),
        source,
    }
}
